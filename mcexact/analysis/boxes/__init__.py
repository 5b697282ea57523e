"""Decisions about every plant in a box, by discs on which a pencil is regular for every member.

===========  ==================================================================================
`pencils`    radii of plants and derived systems, pencils, and the exact test of a disc
`cover`      discs that contain the eigenvalues of all members, and trees of squares over them
`cells`      proofs about families: boxes, and ranges of parameters cut into cells
`members`    fixed modes, controllability and set-points of every member
`loops`      closed loops of every member
`failure`    nearby members that fail, by small changes with which a pencil loses rank
`samples`    nearby sampled plants whose loop fails, by gradients of the exponential
`largest`    the largest box or ranges with a proof, and the nearest member that fails
===========  ==================================================================================
"""

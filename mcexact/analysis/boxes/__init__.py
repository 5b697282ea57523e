"""Decisions about every plant in a box, by discs on which a pencil is regular for every member.

========================  =============================================================
`radii`                   the radii of plants, and of systems derived from them
`regular_discs`           the exact test of a disc, in integers
`float_pencils`           pencils in floating point, which propose the evidence of a disc
`gain_search`             gains with which a mode is far from being fixed
`exterior`                discs that contain the eigenvalues of all members
`cover`                   the tree of squares that covers these discs
`box_fixed`               whether a member has a fixed mode
`parameter_cells`         boxes around the plants at all values of parameters in a cell
`cut_ranges`              the ranges of parameters, cut until each cell is proved
`parametric_box`          the questions about fixed modes and control for all values in ranges
`parametric_box_stable`   one loop for all values in ranges
========================  =============================================================
"""

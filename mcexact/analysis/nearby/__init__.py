"""Plants near a given one, with the same zeros, of which an answer is another one.

=============  ====================================================================================
`suspects`     modes that hardly move, and widest paths from what shows them to what acts on them
`corrections`  exact plants near a suspected one, and what the data of a plant allow
`plants`       the search, its certificates, and what it says
`equalities`   why modes of the given plant are fixed: plants with other numbers at the same places
=============  ====================================================================================
"""

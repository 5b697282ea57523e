"""Plants near a given one, with the same zeros, of which an answer is another one.

=============  ====================================================================================
`suspects`     modes that hardly move, and widest paths from what shows them to what acts on them
`allowances`   what the data of a plant allow its entries to differ by
`corrections`  exact plants near a suspected one
`plants`       what was found, and its words
`search`       the search, and its certificates
=============  ====================================================================================
"""

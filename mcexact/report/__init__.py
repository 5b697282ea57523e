"""Results for people and for programs: text, JSON, HTML and figures.

Takes results of the earlier stages and changes none of them.
"""

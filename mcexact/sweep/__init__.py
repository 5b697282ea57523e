"""Stage 6: the same questions about many systems, over any ``concurrent.futures`` executor.

Takes system files, systems and draws; gives one record for each, as they are finished, and keeps
them in a file from which an interrupted sweep goes on.  What crosses a process is text, and every
certificate that comes back is checked here before its claim is believed.

=============  ====================================================================
`questions`    what can be asked
`jobs`         one system and what is asked about it: decided in any process
`records`      what was found, and the file that keeps it
`workers`      processes that may die
`run`          `sweep` itself
=============  ====================================================================
"""

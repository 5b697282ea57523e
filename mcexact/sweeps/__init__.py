"""The same questions about many systems, over any ``concurrent.futures`` executor.

This stage takes system files, systems and draws, and gives one record for each as it is finished.
A file of records lets an interrupted sweep resume.  Processes exchange texts only, and the
receiving process verifies every certificate before it uses the claim.

=============  ====================================================================
`questions`    the questions of a sweep
`workers`      worker processes, which may die
`jobs`         one system with its questions, decided in any process
`run`          `sweep` itself, the records of its answers, and the file of records
=============  ====================================================================
"""

"""System files of other programs: MATLAB, numpy, folders of .csv files and YAML, read and written.

=============  =============================================================================
`reading`      what every reader is told: limits, rounding, sizes of channels
`parts`        the matrices, names and texts that such a file has, and the system of them
`arrays`       arrays of floats and integers to exact matrices, and back without loss
`mat`          files of MATLAB, version 5 (``save -v7``)
`npz`          archives of numpy
`csv_folder`   a folder, or an archive, of .csv files
`yaml_text`    YAML, with numbers as typed
`recognize`    which of these a file is
`files`        `load_system` and `save_system`
=============  =============================================================================

Nothing in a file is executed or unpickled, and no more memory is taken than ``Limits.bytes`` allows
a file, however much its compressed contents claim.
"""

"""Controllers as code: difference equations, C99 and Structured Text of IEC 61131-3.

`equations`   what an agent computes in each step, as sums, and an interpreter in doubles
`fixed`       the same in integers, and how many bits are enough
`code`        the sums as C, and as function blocks
`compiled`    the C, compiled and called
"""

MOST_BITS = 48
"""The most fractional bits of a number in fixed point."""

"""The one exception of the module."""

from collections.abc import Iterable


class Error(ValueError):
    """What was asked for cannot be done; `problems` lists everything that is wrong, one sentence each.

    >>> import capstan as cp
    >>> try:
    ...     cp.Cable(length_m=2.0, axial_stiffness_N=-9e3, friction=0.1, pretension_N=-5.0)
    ... except cp.Error as error:
    ...     print(*error.problems, sep="\\n")
    axial_stiffness_N: is -9000, but must be above 0
    pretension_N: is -5, but must be 0 or more
    """

    problems: list[str]

    def __init__(self, problems: Iterable[str]) -> None:
        self.problems = list(problems)
        super().__init__("\n".join(self.problems))

    def __reduce__(self) -> tuple[type["Error"], tuple[list[str]]]:
        return Error, (self.problems,)

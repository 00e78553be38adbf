# SPDX-License-Identifier: Apache-2.0
"""What pierce raises beside TypeError: one class for each kind of error, all of them Error."""

from __future__ import annotations


class Error(Exception):
    """Base of all errors of pierce.

    The text is one line: the first offender, how many there are, and the cure.

    Attributes:
        index: number of the first offender (of a ray in its flattened batch, a triangle in its
            mesh), or None.
        count: how many offenders there are, as far as they were looked for.
    """

    index: int | None = None
    count: int = 1


class NonFiniteVertex(Error, ValueError):
    """A vertex that some triangle uses has a NaN or an infinity."""


class IndexOutOfRange(Error, IndexError):
    """A triangle names a vertex that does not exist."""


class TooManyTriangles(Error, ValueError):
    """2^32 - 1 triangles or more in one scene."""


class InvalidRay(Error, ValueError):
    """A ray has a NaN or an infinity, a zero direction, or a NaN range."""


class InvalidPoint(Error, ValueError):
    """A query point has a NaN or an infinity."""


class SizeMismatch(Error, ValueError):
    """Two arrays that must have the same length do not."""


class InvalidArgument(Error, ValueError):
    """Any other argument that is not what its description asks for."""


class NotClosed(Error, ValueError):
    """The query needs a closed mesh and this one is not."""

    def __init__(self, text: str = "") -> None:
        for option, argument in (("the open-mesh option", "open_mesh=True or rule='winding'"),
                                 ("the rule Odd", "rule='odd'")):
            text = text.replace(option, argument)
        super().__init__(text)


class UnknownKernel(Error, RuntimeError):
    """The environment variable PIERCE_KERNEL names what this machine does not have."""


class Stopped(Error, RuntimeError):
    """The call was told to stop."""


class BadFile(Error, ValueError):
    """A file that cannot be read, or does not hold what it should."""


class MeshWarning(UserWarning):
    """A mesh file was read, but something in it is not as it should be."""

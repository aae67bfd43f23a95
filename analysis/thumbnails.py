"""Small pictures of logged individuals, each drawn once."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Final, final

from genome.errors import InputError
from genome.mishaps import one_line
from orchestrator.folder import RunFolder
from orchestrator.regrow import Nursery, by_id

if TYPE_CHECKING:
    from PIL.Image import Image

SIZE: Final = (240, 180)
"""Pixels."""

QUALITY: Final = 86
"""Of a JPEG."""


@final
class Thumbnails:
    """Draws individuals of a run.

    Parameters
    ----------
    folder
        The run.
    size
        Width and height in pixels; :data:`SIZE` without.

    Attributes
    ----------
    troubles
        Why pictures are missing, in the order in which that was found out; each once.
    """

    def __init__(self, folder: RunFolder, size: tuple[int, int] | None = None) -> None:
        self._folder: Final = folder
        self._size: Final = size or SIZE
        self._nursery: Nursery | None = None
        self._drawn: Final[dict[int, Image | None]] = {}
        self.troubles: Final[dict[str, None]] = {}

    def of(self, identity: int) -> Image | None:
        """Draw an individual; ``None`` where that cannot be done, which is then one of ``troubles``."""
        if identity not in self._drawn:
            self._drawn[identity] = self._picture(identity)
        return self._drawn[identity]

    @property
    def shown(self) -> bool:
        """Whether any picture could be drawn."""
        return any(image is not None for image in self._drawn.values())

    def _picture(self, identity: int) -> Image | None:
        try:
            if self._nursery is None:
                self._nursery = Nursery(self._folder)
            (logged,) = by_id(self._folder, [identity])
            image = self._nursery.picture(logged, self._size)
        except InputError as error:
            self.troubles[one_line(str(error))] = None
            return None
        if image is None:
            self.troubles[f"{logged.island}: individuals of its kind have no picture, or grow to no form"] = None
        return image


def jpeg(image: Image) -> bytes:
    """Write a picture as JPEG."""
    stream = io.BytesIO()
    image.save(stream, format="JPEG", quality=QUALITY, optimize=True)
    return stream.getvalue()

"""Animations of timed forms: what lives from one drawing to the next, and files that show it move."""

from growth.timed.animation.files import FORMS, write_drawings
from growth.timed.animation.glb import animated_glb
from growth.timed.animation.pictures import contact_sheet, gif, pictures
from growth.timed.animation.segments import Segment, segments

__all__ = ["FORMS", "Segment", "animated_glb", "contact_sheet", "gif", "pictures", "segments", "write_drawings"]

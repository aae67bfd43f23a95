"""Criteria of plans: rooms next to those they should be, light, sun, view and street, ways through, the site.

Rosenman 1997, section 3.3.1.
"""

from evaluators.plans.brief import Adjacency, Brief, RoomWish, Side, SiteWish
from evaluators.plans.layout import Door, Layout, laid_out
from evaluators.plans.registry import COSTLY, PLAN_CRITERIA, resolve, score

__all__ = [
    "COSTLY",
    "PLAN_CRITERIA",
    "Adjacency",
    "Brief",
    "Door",
    "Layout",
    "RoomWish",
    "Side",
    "SiteWish",
    "laid_out",
    "resolve",
    "score",
]

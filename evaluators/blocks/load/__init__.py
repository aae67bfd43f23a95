"""Load on bodies of blocks: what their weight does to their joints (Senatore 2009, 'the load propagation model').

A body hangs together by joints between neighbours; its layers (:mod:`~evaluators.blocks.load.layers`) are counted from
the foundation. The models are :mod:`~evaluators.blocks.load.galasyn` and :mod:`~evaluators.blocks.load.rigid`, which
slice it layer by layer (:mod:`~evaluators.blocks.load.cuts`), :mod:`~evaluators.blocks.load.frame`, the accurate
reference, and :mod:`~evaluators.blocks.load.limit`, the load that plastic joints can bear.
:mod:`~evaluators.blocks.load.stages` loads a body while it grows.
"""

from evaluators.blocks.load.analysis import analyse
from evaluators.blocks.load.load import Load
from evaluators.blocks.load.settings import LoadSettings
from evaluators.blocks.load.stages import grown_under_load, loaded_throughout

__all__ = ["Load", "LoadSettings", "analyse", "grown_under_load", "loaded_throughout"]

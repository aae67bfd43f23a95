"""The environment: forces that pull on growth, and boundaries that it may not pass (Hemberg 2006, section 4.7).

Forces are gravity, attractors and repellers. Boundaries are convex shapes or closed meshes; hard ones stop every
vertex on its way, soft ones are only counted. The file format is in docs/formats/environment.md.
"""

from growth.environment.environment import Environment
from growth.environment.load import environment_among, environment_from, load_environment
from growth.environment.settings import EnvironmentSettings, environment_settings

__all__ = [
    "Environment",
    "EnvironmentSettings",
    "environment_among",
    "environment_from",
    "environment_settings",
    "load_environment",
]

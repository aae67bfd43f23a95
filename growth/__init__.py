"""Growth: from rules to form, as a function of (rules, environment, budget) that may fail as a value.

Engines share the budget and the failure of :mod:`~growth.protocol`, and the form of :mod:`~growth.surface`.
:mod:`~growth.hemls` grows surfaces; :mod:`~growth.environment` pulls on them and bounds them. :mod:`~growth.forms` and
:mod:`~growth.pictures` write what has grown. Nothing here knows of genotypes, fitness or evolution.
"""

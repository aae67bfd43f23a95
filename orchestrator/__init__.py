"""The orchestrator: what stands around the islands, from the experiment's file to the verdict.

An experiment is read and checked (:mod:`~orchestrator.loading`, by the models of :mod:`~orchestrator.experiment`),
laid out as islands and edges (:mod:`~orchestrator.plan`, :mod:`~orchestrator.topology`), and run
(:mod:`~orchestrator.run`): a pure state machine (:mod:`~orchestrator.archipelago`) decides what the hosts do next, and
a backend (:mod:`~orchestrator.backends`) has them do it, in this process or through Ray. The driver moves boxes of
migrants and never looks into them. A run leaves a folder (:mod:`~orchestrator.folder`), whose log can be asked
(:mod:`~orchestrator.query`), hashed (:mod:`~orchestrator.digest`) and brought back to life
(:mod:`~orchestrator.regrow`). :mod:`~orchestrator.cli` is the door.
"""

"""Steering a run from outside: the command language, and how a command gets to the run and into its history.

``atoll steer`` reads words into a :class:`~orchestrator.steering.command.Request` and checks it
(:mod:`~orchestrator.steering.language`), leaves it in the run's folder and waits
(:mod:`~orchestrator.steering.mailbox`). The run's driver looks there, checks it again, decides the epoch in which it
takes effect, writes it into ``commands.jsonl`` (:mod:`~orchestrator.steering.journal`), tells the hosts, and answers.
What islands make of it is the matter of :mod:`islands.interventions`; how islands and channels come and go that of
:mod:`~orchestrator.steering.structure`.
"""

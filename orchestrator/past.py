"""What a run was bred with until a checkpoint, and whether what stands in its folder is still that.

A run that goes on with other settings, or without the commands that steered it, would be no run that ever was: no
replay could show it again.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from typing import Any, Final

from genome.errors import InputError
from orchestrator.checkpoints import Checkpoint
from orchestrator.folder import RunFolder
from orchestrator.loading import Loaded
from orchestrator.steering.command import Command

FREE: Final = ("generations", "epochs", "hosts", "backend", "deadlines", "log", "checkpoint", "forms")
"""Settings that may change when a run goes on: what happened until then does not hang on them."""


def facts_of(loaded: Loaded, commands: Sequence[Command]) -> dict[str, Any]:
    """Give what a checkpoint keeps of it: a hash of the settings that count, and one of the commands until then."""
    settings = {key: value for key, value in loaded.data().items() if key not in (*FREE, "name")}
    return {"settings": _hash(settings), "steered": _hash([one.to_json() for one in commands])}


def refuse_changed(checkpoint: Checkpoint, folder: RunFolder, loaded: Loaded, commands: Sequence[Command]) -> None:
    """Refuse to go on from a checkpoint of other settings or commands.

    Raises
    ------
    InputError
        When the experiment or the commands are not those that the run was bred with.
    """
    found = facts_of(loaded, commands[: checkpoint.commands])
    where = f"the checkpoint of epoch {checkpoint.epoch}"
    if checkpoint.facts.get("settings", found["settings"]) != found["settings"]:
        got = "other islands, channels or settings"
        remedy = "take back what was changed, or start a new run with it"
        raise InputError(folder.source, f"the experiment that {where} was bred with", got, remedy)
    if len(commands) < checkpoint.commands or checkpoint.facts.get("steered", found["steered"]) != found["steered"]:
        got = f"{len(commands)} commands" if len(commands) < checkpoint.commands else "others"
        place = str(folder.store.at("commands.jsonl"))
        raise InputError(place, f"the {checkpoint.commands} commands that {where} was steered by", got, "put them back")


def _hash(value: Any) -> str:  # noqa: ANN401 - plain JSON values
    return hashlib.sha256(json.dumps(value, sort_keys=True).encode()).hexdigest()

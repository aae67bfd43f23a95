"""The command line: ``atoll COMMAND``. Each command is a module of its own, imported when it is called."""

from __future__ import annotations

import importlib
from typing import Any, Final, final

import click

from genome.errors import InputError

COMMANDS: Final = {
    "run": "Run an experiment.",
    "resume": "Go on with a run from its last checkpoint.",
    "steer": "Intervene in a running run.",
    "show": "Show how a run stands.",
    "report": "Write one HTML file that shows a run.",
    "sheet": "Draw a run's forms side by side.",
    "chart": "Draw a score over a run's generations.",
    "query": "Put an SQL query to a run's log.",
    "export": "Write forms of a run's individuals.",
    "refine": "Repair, remesh or smooth a form, or make it a solid.",
    "replay": "Run a run again, or one of its individuals, and compare.",
    "digest": "Give one hash of what happened in a run.",
    "grow": "Grow one form, without evolution.",
    "check": "Validate a file without running it.",
    "schema": "Print the JSON Schema of the experiment file.",
    "validate": "Reproduce published behaviour of island models.",
}
"""The commands in the order of the help; ``orchestrator.commands.NAME`` holds each as ``command``."""

ELSEWHERE: Final = {name: f"analysis.commands.{name}" for name in ("chart", "report", "sheet")}
"""Commands of rooms that stand on this one: they are found by name, since nothing here imports those."""


class Complaint(click.ClickException):
    """One clear message on stderr, and an exit code."""

    def __init__(self, message: str, code: int) -> None:
        super().__init__(message)
        setattr(self, "exit_code", code)  # noqa: B010 - click declares it for the class, and reads it here

    def show(self, file: Any = None) -> None:  # noqa: ANN401 - as click declares it
        """Print the message."""
        click.echo(f"atoll: {self.message}", err=True, file=file)


@final
class LazyGroup(click.Group):
    """A group that imports a command's module when the command is called, so that ``--help`` is quick."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Give the commands' names."""
        del ctx
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import a command; ``None`` for an unknown one."""
        del ctx
        if cmd_name not in COMMANDS:
            return None
        found = importlib.import_module(ELSEWHERE.get(cmd_name, f"orchestrator.commands.{cmd_name}")).command
        assert isinstance(found, click.Command)
        return found

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Find the command that is called; one that is not there is told with the nearest that is."""
        if args and args[0] not in COMMANDS and not args[0].startswith("-"):
            from genome.settings import near

            ctx.fail(f"No such command '{args[0]}'; {near(args[0], list(COMMANDS))}")
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the commands into the help without importing them."""
        del ctx
        with formatter.section("Commands"):
            formatter.write_dl(list(COMMANDS.items()))

    def invoke(self, ctx: click.Context) -> Any:  # noqa: ANN401 - as click declares it
        """Call the command, and turn the errors that are expected into one message and an exit code."""
        try:
            return super().invoke(ctx)
        except InputError as error:
            raise Complaint(str(error), 2) from None
        except KeyboardInterrupt:
            raise Complaint("interrupted", 130) from None
        except MemoryError:
            raise Complaint(
                "this machine has not enough memory for that; lower the budget (max_elements, ...)", 1
            ) from None
        except SystemError as error:
            # A Ctrl-C that strikes while a compiled kernel takes its arguments comes wrapped in this.
            if _interrupted(error):
                raise Complaint("interrupted", 130) from None
            raise
        except OSError as error:
            if isinstance(error, BrokenPipeError):
                raise
            place = f"{error.filename}: " if error.filename else ""
            raise Complaint(f"{place}{error.strerror or error}", 1) from None


def _interrupted(error: BaseException | None) -> bool:
    """Tell whether a Ctrl-C is among an exception's causes."""
    while error is not None and not isinstance(error, KeyboardInterrupt):
        error = error.__cause__ or error.__context__
    return error is not None


@click.command(
    cls=LazyGroup,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 110},
    epilog="Example: atoll run experiments/drape.yaml",
)
@click.version_option(package_name="atoll", prog_name="atoll")
def main() -> None:
    """Grow architectural form from evolved instructions, on an archipelago of islands."""


if __name__ == "__main__":
    main()

"""Packages that come with extras: imported when they are needed, and named when they are missing."""

from __future__ import annotations

from importlib import import_module
from typing import Any


def needed(module: str, extra: str) -> Any:
    """A module that an extra installs.

    Raises
    ------
    ModuleNotFoundError
        With the name of the extra that installs it.
    """
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        if error.name is not None and error.name.partition(".")[0] != module.partition(".")[0]:
            raise
        message = f'this needs {module.partition(".")[0]}: pip install "stickslip[{extra}]"'
        raise ModuleNotFoundError(message, name=error.name) from None

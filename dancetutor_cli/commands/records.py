"""Options of a command as one record: a dataclass whose fields are named like them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from functools import wraps
from typing import Any


def into(name: str, kind: type) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Give a command one argument `name`, a `kind`, in place of the options that are called like its fields.

    To stand below the options: ``@options`` first, then ``@into("wish", Wish)``, then the function.
    """
    known = tuple(field.name for field in fields(kind))

    def decorate(command: Callable[..., Any]) -> Callable[..., Any]:
        @wraps(command)
        def gathered(**given: Any) -> Any:
            record = kind(**{field: given.pop(field) for field in known if field in given})
            return command(**given, **{name: record})

        return gathered

    return decorate

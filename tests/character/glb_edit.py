"""Edit a GLB's JSON in tests: to make other programs' naming styles and hostile files out of the mannequin."""

from __future__ import annotations

import json
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any


def parts_of(data: bytes) -> tuple[dict[str, Any], bytes]:
    """The JSON document and the binary chunk."""
    length = struct.unpack_from("<I", data, 12)[0]
    document = json.loads(data[20 : 20 + length])
    return document, data[28 + length :]


def joined(document: dict[str, Any] | bytes, binary: bytes) -> bytes:
    """A GLB of a document (or raw JSON bytes) and a binary chunk."""
    text = document if isinstance(document, bytes) else json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    body = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body


def edited(source: Path, target: Path, change: Callable[[dict[str, Any]], object]) -> Path:
    """Write `source` with its document changed to `target`."""
    document, binary = parts_of(source.read_bytes())
    change(document)
    target.write_bytes(joined(document, binary))
    return target

"""Types of the practice page's document for TypeScript, from docs/page.schema.json.

`python tools/page_types.py` writes dancetutor_cli/page/js/doc.d.ts; `--check` only says whether it is up to date.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
SCHEMA = ROOT / "docs" / "page.schema.json"
TYPES = ROOT / "dancetutor_cli" / "page" / "js" / "doc.d.ts"
_SIMPLE = {"number": "number", "integer": "number", "string": "string", "boolean": "boolean", "null": "null"}
_LONGEST = 4  # numbers of a tuple that is written out


def types_of(schema: dict[str, Any]) -> str:
    """The declarations of a schema and its $defs."""
    head = "// Made by tools/page_types.py from docs/page.schema.json: change that, not this.\n"
    named = {**schema["$defs"], schema["title"]: schema}
    return head + "".join(f"\n{_comment(one)}export type {name} = {_type(one)};\n" for name, one in named.items())


def _comment(schema: dict[str, Any], indent: str = "") -> str:
    return f"{indent}/** {schema['description']} */\n" if "description" in schema else ""


def _type(schema: dict[str, Any], indent: str = "") -> str:
    """The type of one schema; ValueError for a form of schema that is not used here."""
    if "$ref" in schema:
        return str(schema["$ref"]).rpartition("/")[2]
    if "const" in schema or "enum" in schema:
        return " | ".join(json.dumps(value) for value in schema.get("enum", [schema.get("const")]))
    if "anyOf" in schema:
        return " | ".join(_type(one, indent) for one in schema["anyOf"])
    kind = schema["type"]
    if isinstance(kind, list):
        return " | ".join(_SIMPLE[one] for one in kind)
    if kind in _SIMPLE:
        return _SIMPLE[kind]
    if kind == "array":
        return _list(schema, indent)
    if kind == "object":
        return _object(schema, indent)
    raise ValueError(f"no type for {schema}")


def _list(schema: dict[str, Any], indent: str) -> str:
    if "prefixItems" in schema:
        return f"[{', '.join(_type(one, indent) for one in schema['prefixItems'])}]"
    item, length = _type(schema["items"], indent), schema.get("minItems", 0)
    if 0 < length <= _LONGEST and schema.get("maxItems") == length:
        return f"[{', '.join([item] * length)}]"
    return f"({item})[]" if "|" in item else f"{item}[]"


def _object(schema: dict[str, Any], indent: str) -> str:
    if "properties" not in schema:
        return f"Record<string, {_type(schema['additionalProperties'], indent)}>"
    inner = indent + "  "
    lines = [
        f"{_comment(one, inner)}{inner}{name}{'' if name in schema['required'] else '?'}: {_type(one, inner)};\n"
        for name, one in schema["properties"].items()
    ]
    return "{\n" + "".join(lines) + indent + "}"


def main() -> int:
    text = types_of(json.loads(SCHEMA.read_text("utf-8")))
    if "--check" in sys.argv[1:]:
        fresh = TYPES.exists() and TYPES.read_text("utf-8") == text
        if not fresh:
            print(f"{TYPES.relative_to(ROOT)} is not what tools/page_types.py makes", file=sys.stderr)
        return int(not fresh)
    TYPES.write_text(text, "utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())

"""Names that files of earlier versions have, and what they are called now."""

import json

NAMES = {"kernel": "backend", "inner": "stores"}
"""Fields of a manifest, of its sessions, and of the head of a checkpoint."""


def with_names(content: bytes) -> bytes:
    """JSON whose fields have the names of this version.

    Args:
        content: Of a file; one without old names comes back as it is.

    Raises:
        ValueError: It is not JSON.
    """
    if not any(f'"{old}"'.encode() in content for old in NAMES):
        return content
    found = json.loads(content)
    if not isinstance(found, dict):
        return content
    sessions = found.get("sessions", ())
    for each in (found, *(sessions if isinstance(sessions, list) else ())):
        for old, name in NAMES.items():
            if isinstance(each, dict) and old in each and name not in each:
                each[name] = each.pop(old)
    return json.dumps(found).encode()

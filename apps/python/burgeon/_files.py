"""Files that are there whole or not at all."""

from __future__ import annotations

import contextlib
import os
import tempfile
from typing import Iterable, Tuple


def write_whole(folder: str, files: "Iterable[Tuple[str, bytes]]") -> None:
    """Writes files beside their places and renames them; after an error none of them is there, the old ones still are."""
    folder = folder or "."
    drafts = []
    try:
        for name, data in files:
            handle, draft = tempfile.mkstemp(prefix=f".{name}-", suffix=".draft", dir=folder)
            drafts.append((draft, os.path.join(folder, name)))
            with os.fdopen(handle, "wb") as out:
                out.write(data)
                out.flush()
                os.fsync(out.fileno())
            mask = os.umask(0)
            os.umask(mask)
            os.chmod(draft, 0o666 & ~mask)
        # The first is what names the others: last.
        for draft, place in reversed(drafts):
            os.replace(draft, place)
        drafts = []
    finally:
        for draft, _ in drafts:
            with contextlib.suppress(OSError):
                os.unlink(draft)

"""Files that are there whole or not at all."""

from __future__ import annotations

import contextlib
import os
import tempfile
from typing import Iterable, List, Tuple


def write_whole(folder: str, files: "Iterable[Tuple[str, bytes]]") -> None:
    """Writes files beside their places and renames them; after an error none of them is there, the old ones still are."""
    folder = folder or "."
    drafts: "List[Tuple[str, str]]" = []
    place = folder
    try:
        for name, data in files:
            place = os.path.join(folder, name)
            handle, draft = tempfile.mkstemp(prefix=f".{name}-", suffix=".draft", dir=folder)
            drafts.append((draft, place))
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
    except OSError as error:
        # Of the file that was asked for: nobody knows the drafts.
        raise OSError(error.errno, error.strerror, place) from None
    finally:
        for draft, _ in drafts:
            with contextlib.suppress(OSError):
                os.unlink(draft)

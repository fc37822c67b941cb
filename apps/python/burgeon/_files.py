"""Files that are there whole or not at all."""

from __future__ import annotations

import contextlib
import os
import stat
import tempfile
from typing import Any, Iterable, List, Tuple


def inside(folder: "str | os.PathLike[str]", name: Any) -> str:
    """The path of a file that a file of a data set names: one of the same folder, not a link out of it, not a pipe or device.

    A data set is a folder that moves as a whole, so there is no need to trust it with paths. Of a file that is not there the path
    as well: who opens it says so.
    """
    if not isinstance(name, str) or name in ("", ".", "..") or "/" in name or "\\" in name or "\0" in name:
        raise ValueError(
            f"{os.fspath(folder)}: {name!r} is not the name of a file beside its manifest; download the data set again"
        )
    path = os.path.join(folder, name)
    real = os.path.realpath(path)
    if os.path.dirname(real) != os.path.realpath(folder):
        raise ValueError(f"{path}: a link that leads out of the data set; copy the file there")
    if os.path.exists(real) and not stat.S_ISREG(os.stat(real).st_mode):
        raise ValueError(f"{path}: not a file; download the data set again")
    return path


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

"""Files that are written completely or not at all."""

from __future__ import annotations

import contextlib
import os
import stat
import tempfile
from typing import Any, Iterable, List, Tuple


def inside(folder: "str | os.PathLike[str]", name: Any) -> str:
    """Returns the path of a file that a file of a data set names: in the same folder, not a link out of it, not a pipe or device.

    A data set is a folder that moves as a whole, so there is no need to trust it with paths. A missing file gives its path as
    well: opening it raises the error.
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
    """Writes files next to their places and renames them; after an error there are none of them, and the old ones remain."""
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
        # The first file names the others, so it comes last.
        for draft, place in reversed(drafts):
            os.replace(draft, place)
        drafts = []
    except OSError as error:
        # Names the requested file: nobody knows the drafts.
        raise OSError(error.errno, error.strerror, place) from None
    finally:
        for draft, _ in drafts:
            with contextlib.suppress(OSError):
                os.unlink(draft)

"""Labelled clouds as LAS and LAZ files (laspy)."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Mapping

if TYPE_CHECKING:
    import numpy as np

GRID_M = 0.0001
"""Step of coordinates, metres."""
LABELS = ("part", "axis", "organ", "order", "distance", "tree", "instance", "share")
"""Columns that become separate dimensions."""


def las(cloud: "Mapping[str, np.ndarray]", packed: bool) -> bytes:
    """Returns LAS 1.4, point format 6, metres, +z up; the station is the point source, the share of the path the GPS time. The
    same cloud gives the same bytes."""
    import datetime

    import numpy as np

    try:
        import laspy
    except ImportError as error:
        raise ImportError("LAS and LAZ need laspy: pip install 'laspy[lazrs]>=2.5'") from error
    points = np.asarray(cloud["points"])
    header = laspy.LasHeader(version="1.4", point_format=6)
    # The date is fixed, because the bytes must not depend on the day.
    header.creation_date = datetime.date(2000, 1, 1)
    header.generating_software = "burgeon"
    placed = np.column_stack([points[:, 0], -points[:, 2], points[:, 1]])
    header.scales = np.full(3, GRID_M)
    header.offsets = np.floor(placed.min(axis=0)) if len(placed) else np.zeros(3)
    for name in LABELS:
        if name in cloud:
            header.add_extra_dim(laspy.ExtraBytesParams(name=name, type=cloud[name].dtype))
    file = laspy.LasData(header)
    file.x, file.y, file.z = placed.T
    file.point_source_id = cloud["station"].astype(np.uint16)
    # The format has room for fifteen echoes of a beam.
    file.return_number = np.minimum(cloud["echo"], 14) + 1
    file.number_of_returns = np.minimum(cloud["echoes"], 15)
    file.gps_time = cloud["time"]
    for name in LABELS:
        if name in cloud:
            file[name] = cloud[name]
    out = io.BytesIO()
    file.write(out, do_compress=packed)
    return out.getvalue()

"""Light on plants: the table of the command, as arrays."""

import csv
import datetime
import os
import subprocess

import numpy as np
import pytest

import burgeon as bg

FEW = {"rays": 20_000}


@pytest.fixture(scope="module")
def hazel():
    return bg.grow("hazel", seed=3, age=3, textures=False)


def test_the_columns_are_those_of_the_command(tmp_path):
    program = os.environ.get("BURGEON")
    if not program:
        pytest.skip("the environment does not name the program (BURGEON)")
    args = ["--sun", "150,40", "--direct", "200", "--diffuse", "60", "--repeat", "2x1.5", "--rays", "20000", "--seed", "3"]
    subprocess.run([program, "light", "hazel", *args, "-o", tmp_path / "x.csv", "-q"], check=True)
    with open(tmp_path / "x.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    light = bg.grow("hazel", seed=3, textures=False).light(sun=(150, 40), direct=200, diffuse=60, repeat=(2, 1.5), rays=20_000)
    assert len(rows) == len(light.part) > 100
    for ours, theirs in (
        ("area", "area_m2"),
        ("height", "height_m"),
        ("incident", "incident_w_m2"),
        ("absorbed", "absorbed_w_m2"),
        ("fapar", "fapar"),
        ("lines", "lines"),
    ):
        assert getattr(light, ours).tolist() == [float(row[theirs]) for row in rows], ours
    assert [bg.PARTS[part] for part in light.part] == [row["kind"] for row in rows]
    assert light.row.tolist() == [int(row["id"]) for row in rows]
    told = [float(row["sunlit"]) if row["sunlit"] else np.nan for row in rows]
    np.testing.assert_array_equal(light.sunlit, told)


def test_rows_belong_to_the_tables_of_the_plant(hazel):
    light = hazel.light(**FEW)
    leaf = bg.PARTS.index("leaf")
    own = light.part == leaf
    assert (hazel.organs.part[light.row[own]] == leaf).all()
    assert own.sum() > 20 and (light.absorbed[own] > 0).any()
    assert np.isnan(light.sunlit).all() and light.figures["unit"] == "W" and light.figures["sky"] == "overcast"
    assert set(light.to_dict()) == set(bg.Light._fields) - {"figures", "warnings"}
    # Light that is not absorbed is reflected or transmitted: 15 % of leaves.
    np.testing.assert_allclose(light.absorbed[own], 0.85 * light.incident[own], rtol=1e-9)


def test_energy_is_kept_in_a_stand(hazel):
    balance = hazel.light(repeat=(1.5, 1.5), **FEW).figures["balance"]
    parts = sum(balance[name] for name in ("plants", "soil", "reflected", "lost"))
    assert parts == pytest.approx(balance["incoming"], rel=1e-3)


def test_a_day_is_counted_in_megajoules(hazel):
    day = datetime.date(2026, 6, 21)
    light = hazel.light(place=(48.1, 11.6), date=day, daily=True, **FEW)
    same = hazel.light(place=(48.1, 11.6, 0), date="2026-06-21", daily=True, **FEW)
    assert light.figures["unit"] == "MJ" and 5 < light.figures["incoming_per_m2"] < 20
    assert light.absorbed.tolist() == same.absorbed.tolist()
    noon = hazel.light(place=(48.1, 11.6), date=(2026, 6, 21), hour=12, **FEW).figures
    assert 60 < noon["sun_elevation_deg"] < 66 and noon["sky"] == "clear"


def test_plants_of_a_grove_shade_one_another(hazel):
    alone = hazel.light(**FEW).figures["leaf_share"]
    places = {
        "position": [(0, 0, 0), (0.25, 0, 0), (-0.25, 0, 0)],
        "yaw_deg": [0, 90, 180],
        "scale": [1, 1, 1],
        "plant": [0, 0, 0],
    }
    grove = bg.Grove([hazel], places).light(**FEW)
    assert set(grove.plant.tolist()) == {0, 1, 2} and grove.figures["leaf_share"] < 0.95 * alone


def test_a_measured_sky_gives_what_it_says(hazel):
    light = hazel.light(sky_table=[[0, 30, 20], [180, 60, 70]], **FEW)
    assert light.figures["incoming_per_m2"] == pytest.approx(90) and light.figures["sky"] == "measured"


@pytest.mark.parametrize(
    "how, words",
    [
        ({"sky": "blue"}, "sky must be one of"),
        ({"sky": "clear"}, "bright around the sun"),
        ({"direct": 10}, "light of a sun"),
        ({"diffuse": 0}, "there is no light"),
        ({"sun": (180, -5), "direct": 10}, "below the horizon"),
        ({"place": (48, 11)}, "go together"),
        ({"hour": 5}, "is of the sun of a place"),
        ({"place": (98, 11), "date": "2026-06-21"}, r"place\[0\]"),
        ({"place": (48, 11), "date": "2026-02-30"}, "date must be"),
        ({"place": (48, 11), "date": (2026, 2, 30)}, "day"),
        ({"place": (80, 11), "date": "2026-12-21", "daily": True}, "does not rise"),
        ({"place": (48, 11), "date": "2026-06-21", "turbidity": 3, "direct": 1}, "clear day"),
        ({"leaf": (0.7, 0.7)}, "together at most 1"),
        ({"repeat": (0, 1)}, r"repeat\[0\]"),
        ({"rays": 10}, "rays must be"),
        ({"sky_table": [[1, 2]]}, "sky_table must be"),
        ({"sky_table": [[0, -10, 5]]}, "below the horizon"),
    ],
)
def test_light_that_cannot_be_is_told(hazel, how, words):
    with pytest.raises(ValueError, match=words):
        hazel.light(**how)
    with pytest.raises(TypeError):
        hazel.light(brightness=3)

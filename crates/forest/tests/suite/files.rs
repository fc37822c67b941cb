//! From files to stands.

use std::path::PathBuf;

use base::{Run, Seed};
use forest::{
    Crs, Figure, ForestSpec, Ground, GroundSpec, GrownStand, HeightMap, InventorySpec, MapScale, Site,
    grow_stand_on, read_inventory,
};

fn file(name: &str) -> Vec<u8> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/forests").join(name);
    std::fs::read(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

fn spec(name: &str) -> ForestSpec {
    let text = String::from_utf8(file(name)).expect("is text");
    spec::from_toml(&text).unwrap_or_else(|e| panic!("{name}: {e}"))
}

fn grown(spec: &ForestSpec, ground: &Ground) -> GrownStand {
    let grown = grow_stand_on(spec, &Site { ground, masks: &[] }, Seed::new(1), &Run::plain());
    let grown = grown.unwrap_or_else(|e| panic!("{}: {e}", spec.name));
    assert!(grown.stand.validate().next().is_none(), "{}", spec.name);
    grown
}

#[test]
fn a_street_as_a_town_lists_it() {
    let inventory = InventorySpec { year: Some(2026), ..InventorySpec::default() };
    let (stand, report) = read_inventory(&file("street.csv"), &inventory, &Run::plain()).expect("sound");
    assert_eq!((stand.trees.len(), report.rows, report.skipped), (32, 32, 0));
    assert_eq!(stand.species, ["plane-tree", "lime"]);
    assert_eq!((report.height.given, report.height.filled, report.dbh.given), (29, 3, 32));
    // Coordinates of Gauss and Krueger are far from the origin: the stand gets one nearby.
    assert!(stand.trees.iter().all(|t| t.foot_m.length() < 140.0), "{}", stand.origin_m);
    assert_eq!(stand.origin_m.x, 4_471_200.0);
    let text = String::from_utf8(file("street.csv")).unwrap();
    let girth: f64 = text.lines().nth(1).unwrap().split(';').nth(4).unwrap().parse().unwrap();
    assert!((stand.trees[0].dbh_m - girth / 100.0 / base::ops::PI).abs() < 1e-12);
    let filled = stand.trees.iter().filter(|t| !t.given.has(Figure::Height));
    assert!(filled.clone().count() == 3 && filled.clone().all(|t| (2.0..30.0).contains(&t.height_m)));
    assert!(stand.validate().next().is_none());
}

#[test]
fn a_park_in_degrees() {
    let inventory = InventorySpec { crs: Some(Crs::Local), ..InventorySpec::default() };
    let (stand, report) = read_inventory(&file("park.geojson"), &inventory, &Run::plain()).expect("sound");
    assert_eq!((stand.trees.len(), stand.species.len(), report.height.given), (24, 6, 8));
    // 0.0032 by 0.0017 degrees at 48 degrees of latitude.
    let far = stand.trees.iter().map(|t| t.foot_m.length()).fold(0.0, f64::max);
    assert!((100.0..170.0).contains(&far), "{far}");
    assert!(report.report.warnings.is_empty(), "{:?}", report.report.warnings);
    let without = read_inventory(&file("park.geojson"), &InventorySpec::default(), &Run::plain());
    assert!(without.expect_err("no projection").to_string().contains("`local`"));
}

#[test]
fn a_valley_side() {
    let spec = spec("slope.toml");
    let GroundSpec::Png { file: name, metres_per_cell, low_m, high_m, no_data } = &spec.ground else {
        panic!("{:?}", spec.ground)
    };
    let scale =
        MapScale { metres_per_cell: *metres_per_cell, low_m: *low_m, high_m: *high_m, no_data: *no_data };
    let map = HeightMap::from_png(&file(name), &scale, &Run::plain()).expect("16 bits of grey");
    let ground = Ground::Map(map);
    let stand = grown(&spec, &ground).stand;
    assert!(stand.trees.len() > 5_000, "{}", stand.trees.len());
    let mean = |species: &str| {
        let row = stand.species.iter().position(|s| s == species).expect("it stands");
        let heights = stand.trees.iter().filter(|t| usize::from(t.species) == row).map(|t| t.foot_m.y);
        let (sum, count) = heights.fold((0.0, 0.0), |(s, n), h| (s + h, n + 1.0));
        sum / count
    };
    assert!(mean("beech") < mean("spruce") && mean("spruce") < mean("larch"));
    for tree in &stand.trees {
        assert_eq!(ground.height_m(tree.foot_m.x, tree.foot_m.z), Some(tree.foot_m.y));
        assert!(tree.up.y > 0.98 && tree.up.z > -0.2, "leans downhill: {tree:?}");
    }
}

#[test]
fn a_riverside_and_an_orchard() {
    let riverside = spec("riverside.toml");
    let stand = grown(&riverside, &Ground::Flat).stand;
    let river: Vec<glam::DVec2> = riverside.water[0].points.iter().map(|p| glam::DVec2::from(*p)).collect();
    let mean = |species: &str| {
        let row = stand.species.iter().position(|s| s == species).expect("it stands");
        let far =
            |t: &forest::Tree| geom::distance_to_polyline(&river, glam::DVec2::new(t.foot_m.x, t.foot_m.z));
        let distances = stand.trees.iter().filter(|t| usize::from(t.species) == row).filter_map(far);
        let (sum, count) = distances.fold((0.0, 0.0), |(s, n), d| (s + d, n + 1.0));
        sum / count
    };
    assert!(mean("alder") < mean("ash") && mean("ash") < mean("oak"));
    let orchard = grown(&spec("orchard.toml"), &Ground::Flat).stand;
    assert_eq!(orchard.trees.len(), 11 * 7);
}

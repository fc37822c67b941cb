use base::{Budget, CancelToken, Executor};

use super::*;

fn pine(side_m: f64, density_ha: f64, years: u32) -> ForestSpec {
    let pine = SpeciesSpec { name: "pine".into(), seedlings: 0.0, ..SpeciesSpec::default() };
    ForestSpec { area_m: [side_m, side_m], density_ha, years, species: vec![pine], ..ForestSpec::default() }
}

fn grow(spec: &ForestSpec) -> GrownStand {
    grow_stand_on(spec, &Site { ground: &Ground::Flat, masks: &[] }, Seed::new(7), &Run::plain())
        .expect("grows")
}

/// Least-squares slope of y over x.
fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let (mx, my) = (points.iter().map(|p| p.0).sum::<f64>() / n, points.iter().map(|p| p.1).sum::<f64>() / n);
    let xy: f64 = points.iter().map(|p| (p.0 - mx) * (p.1 - my)).sum();
    xy / points.iter().map(|p| (p.0 - mx) * (p.0 - mx)).sum::<f64>()
}

fn named(name: &str, side_m: f64, density_ha: f64, years: u32) -> ForestSpec {
    let mut spec = pine(side_m, density_ha, years);
    spec.species[0].name = name.into();
    spec
}

/// Returns the slope of ln N over ln Dg during self-thinning: from the first decade of closed crowns until trees
/// stand free.
fn thinning(history: &[StandYear]) -> f64 {
    let full = history.iter().filter(|y| (25..=80).contains(&y.year));
    slope(&full.map(|y| (ops::ln(y.mean_dbh_m), ops::ln(y.trees_ha))).collect::<Vec<_>>())
}

#[test]
fn full_stands_thin_themselves_along_reinekes_line() {
    // Reineke (1933): -1.605, the same for all species.
    for name in ["pine", "spruce", "beech", "oak"] {
        let grown = grow(&named(name, 150.0, 6000.0, 80));
        let found = thinning(&grown.history);
        assert!((found + 1.605).abs() < 0.15, "{name}: {found}");
    }
}

#[test]
fn pine_has_the_basal_area_of_unthinned_plots() {
    // Kuehne et al. (2022), Table 1: 250 unthinned plots of Scots pine in Norway, 22 to 109 years (mean 51): 28 m2/ha
    // (deviation 11.7, 8.7 to 56.5), 900 to 6080 trees a hectare, dominant height 6.8 to 28.2 m.
    for density in [2500.0, 6000.0] {
        let grown = grow(&pine(150.0, density, 60));
        for y in grown.history.iter().filter(|y| (30..=60).contains(&y.year)) {
            assert!((16.3..51.4).contains(&y.basal_area_m2_ha), "{y:?}");
            assert!((6.8..28.2).contains(&y.top_height_m), "{y:?}");
        }
    }
}

#[test]
fn sizes_are_spread_as_in_stands() {
    let grown = grow(&pine(150.0, 4000.0, 50));
    let trees = &grown.stand.trees;
    let moments = |of: &dyn Fn(&Tree) -> f64| {
        let n = trees.len() as f64;
        let mean = trees.iter().map(of).sum::<f64>() / n;
        let variance = trees.iter().map(|t| (of(t) - mean) * (of(t) - mean)).sum::<f64>() / n;
        (mean, variance.sqrt() / mean)
    };
    let ((dbh, dbh_spread), (height, height_spread)) = (moments(&|t| t.dbh_m), moments(&|t| t.height_m));
    // Even-aged stands: coefficients of variation of 0.2 to 0.35 for diameters, about half of that for heights.
    assert!((0.1..0.3).contains(&dbh) && (0.15..0.4).contains(&dbh_spread), "{dbh} {dbh_spread}");
    assert!((12.0..22.0).contains(&height) && height_spread < 0.8 * dbh_spread, "{height} {height_spread}");
    let slender = moments(&|t| t.height_m / t.dbh_m).0;
    // Closed stands: slenderness of 80 to 110; free-standing trees 30 to 60.
    assert!((75.0..115.0).contains(&slender), "{slender}");
    let free = grow(&pine(150.0, 20.0, 50));
    let slender =
        free.stand.trees.iter().map(|t| t.height_m / t.dbh_m).sum::<f64>() / free.stand.trees.len() as f64;
    assert!((30.0..70.0).contains(&slender), "{slender}");
}

#[test]
fn light_and_growth_have_their_closed_forms() {
    // Botkin et al. (1972): both curves are about 1 in full light, and 0 at 5 % and 8 % of it.
    for (demand, dark) in [(0.0, 0.05), (1.0, 0.08)] {
        assert!(step::response(dark, demand).abs() < 1e-12);
        assert!((step::response(1.0, demand) - 1.0).abs() < 0.45, "{}", step::response(1.0, demand));
        assert_eq!(step::response(0.0, demand), 0.0);
    }
    // A lone tree stands in full light; one below a much higher one, whose crown covers its own, gets the remaining
    // light.
    let area_spec = pine(100.0, 100.0, 0);
    let area = Area::new(&area_spec, &Site { ground: &Ground::Flat, masks: &[] }).unwrap();
    let tree = |x, height, radius, id| Member {
        x,
        height,
        radius,
        dbh: 0.01 * height,
        id,
        vigour: 1.0,
        ..Member::default()
    };
    let mut pair = vec![tree(0.0, 30.0, 4.0, 0), tree(1.0, 2.5, 1.0, 1), tree(40.0, 2.5, 1.0, 2)];
    let grid = sorted(&mut pair, &area);
    let lights: Vec<f64> = (0..3).map(|i| step::look(&pair, &grid, &area.kinds, i).light).collect();
    let by_id = |id| lights[pair.iter().position(|m| m.id == id).unwrap()];
    assert_eq!((by_id(0), by_id(2)), (1.0, 1.0));
    assert!((by_id(1) - ops::exp(-area.kinds[0].shade)).abs() < 1e-12);
}

#[test]
fn trees_keep_apart_and_out_of_buildings_and_water() {
    let mut spec = pine(120.0, 8000.0, 40);
    spec.species.push(SpeciesSpec {
        name: "beech".into(),
        seedlings: 0.3,
        seed_spread_m: Some(6.0),
        ..SpeciesSpec::default()
    });
    spec.outline = vec![[-60.0, -60.0], [60.0, -60.0], [60.0, 30.0], [-60.0, 60.0]];
    let house = vec![[-10.0, -10.0], [10.0, -10.0], [10.0, 10.0], [-10.0, 10.0]];
    spec.keep_out = vec![house.clone()];
    spec.water = vec![
        crate::Water { points: vec![[-60.0, -40.0], [60.0, -30.0]], width_m: Some(6.0) },
        crate::Water { points: vec![[30.0, 0.0], [40.0, 0.0], [35.0, 12.0]], width_m: None },
    ];
    let grown = grow(&spec);
    let stand = &grown.stand;
    assert!(stand.validate().next().is_none());
    assert!(grown.history.iter().any(|y| y.came > 0), "{:?}", grown.history);
    let outline: Vec<DVec2> = spec.outline.iter().map(|p| DVec2::from(*p)).collect();
    let lake: Vec<DVec2> = spec.water[1].points.iter().map(|p| DVec2::from(*p)).collect();
    let house: Vec<DVec2> = house.iter().map(|p| DVec2::from(*p)).collect();
    let places: Vec<DVec2> = stand.trees.iter().map(|t| DVec2::new(t.foot_m.x, t.foot_m.z)).collect();
    for p in &places {
        assert!(geom::contains(&outline, *p) && !geom::contains(&lake, *p) && !geom::contains(&house, *p));
        assert!(geom::distance_to_segment(DVec2::new(-60.0, -40.0), DVec2::new(60.0, -30.0), *p) > 3.0);
    }
    for (i, p) in places.iter().enumerate() {
        for (j, q) in places.iter().enumerate().take(i) {
            assert!(p.distance(*q) >= 0.5 * (stand.trees[i].dbh_m + stand.trees[j].dbh_m), "{i} {j}");
        }
    }
}

#[test]
fn crowns_grow_away_from_neighbours() {
    // The edge of a stand: trees with all others to the west lean their crowns to the east.
    let grown = grow(&pine(100.0, 2500.0, 40));
    let edge = |is_east: bool| {
        let at = |t: &&Tree| if is_east { t.foot_m.x > 48.5 } else { t.foot_m.x < -48.5 };
        let offsets: Vec<f64> = grown.stand.trees.iter().filter(at).map(|t| t.crown_offset_m.x).collect();
        offsets.iter().sum::<f64>() / offsets.len() as f64
    };
    assert!(edge(true) > 0.15 && edge(false) < -0.15, "{} {}", edge(true), edge(false));
    assert!(grown.stand.trees.iter().all(|t| t.crown_offset_m.length() <= 0.25 * t.crown_width_m));
}

/// Two threads, the later jobs first.
struct Backwards;

impl Executor for Backwards {
    fn for_each(&self, n: usize, job: &(dyn Fn(usize) + Sync)) {
        std::thread::scope(|s| {
            for k in 0..2 {
                s.spawn(move || (0..n).rev().filter(|i| i % 2 == k).for_each(job));
            }
        });
    }
}

#[test]
fn threads_make_no_difference_and_seeds_do() {
    let mut spec = pine(200.0, 3000.0, 30);
    spec.species[0].seedlings = 0.2;
    let site = Site { ground: &Ground::Flat, masks: &[] };
    let threads = Run { executor: &Backwards, ..Run::plain() };
    let one = grow_stand_on(&spec, &site, Seed::new(7), &Run::plain()).unwrap();
    assert_eq!(one, grow_stand_on(&spec, &site, Seed::new(7), &threads).unwrap());
    assert_ne!(one, grow_stand_on(&spec, &site, Seed::new(8), &threads).unwrap());
}

#[test]
fn rows_are_rows() {
    let mut spec = pine(100.0, 1.0, 0);
    spec.species[0] = SpeciesSpec { name: "apple".into(), age_years: [20.0, 20.0], ..SpeciesSpec::default() };
    spec.pattern =
        crate::PlantingPattern::Rows { spacing_m: 5.0, row_m: 10.0, angle_deg: 0.0, jitter_m: 0.0 };
    let grown = grow(&spec);
    assert_eq!(grown.stand.trees.len(), 200);
    let is_on = |t: &Tree| (t.foot_m.x / 5.0).fract() == 0.0 && (t.foot_m.z / 10.0).fract() == 0.0;
    assert!(grown.stand.trees.iter().all(is_on));
}

#[test]
fn species_stand_where_they_like_it() {
    // A slope that rises 20 m to the north, then a plateau.
    let heights = (0..11 * 11).map(|k| (10.0 - (k / 11) as f32).min(5.0) * 8.0).collect();
    let map = crate::HeightMap::new(11, heights, DVec2::splat(20.0), DVec2::splat(-100.0)).unwrap();
    let ground = Ground::Map(map);
    let mut spec = pine(200.0, 1500.0, 10);
    spec.species[0].slope_deg = Some([15.0, 60.0]);
    spec.species.push(SpeciesSpec {
        name: "beech".into(),
        height_m: Some([38.0, 50.0]),
        ..SpeciesSpec::default()
    });
    let grown =
        grow_stand_on(&spec, &Site { ground: &ground, masks: &[] }, Seed::new(3), &Run::plain()).unwrap();
    let beech = grown.stand.species.iter().position(|s| s == "beech").unwrap();
    for t in &grown.stand.trees {
        // Pine fades out towards level ground, beech below 38 m.
        assert!(
            if usize::from(t.species) == beech { t.foot_m.y > 35.0 } else { t.foot_m.y < 39.999 },
            "{t:?}"
        );
        assert_eq!(Some(t.foot_m.y), ground.height_m(t.foot_m.x, t.foot_m.z));
        assert!(t.up.y > 0.99 && (t.up.z > 0.0) == (t.foot_m.y < 39.999), "{t:?}");
    }
}

#[test]
fn masks_thin_the_stand() {
    let gray = |levels: &[u8]| {
        let mut out = Vec::new();
        let mut encoder = png::Encoder::new(&mut out, 2, 2);
        encoder.set_color(png::ColorType::Grayscale);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.write_header().unwrap().write_image_data(levels).unwrap();
        Mask::from_png(&out, &Run::plain()).unwrap()
    };
    let mut spec = pine(100.0, 2000.0, 0);
    spec.masks = vec![crate::MaskSpec { file: "a.png".into(), ..crate::MaskSpec::default() }];
    let masks = [gray(&[0, 255, 128, 0])];
    let site = Site { ground: &Ground::Flat, masks: &masks };
    let grown = grow_stand_on(&spec, &site, Seed::new(3), &Run::plain()).unwrap();
    let count = |west: bool, north: bool| {
        grown.stand.trees.iter().filter(|t| (t.foot_m.x < 0.0) == west && (t.foot_m.z < 0.0) == north).count()
    };
    assert_eq!((count(true, true), count(false, false)), (0, 0));
    let share = count(true, false) as f64 / count(false, true) as f64;
    assert!((0.4..0.65).contains(&share), "{share}");
    spec.area_m = [100.0, 300.0];
    let fault = grow_stand_on(&spec, &site, Seed::new(3), &Run::plain()).unwrap_err();
    assert!(fault.to_string().contains("mask 1 is 2 by 2 cells, the area 100 by 300 m"), "{fault}");
}

#[test]
fn bad_specs_are_refused_with_the_way_out() {
    let refused = |change: &dyn Fn(&mut ForestSpec)| {
        let mut spec = pine(50.0, 1000.0, 10);
        change(&mut spec);
        grow_stand(&spec, &Ground::Flat, Seed::new(1), &Run::plain()).expect_err("refused").to_string()
    };
    assert!(refused(&|s| s.species.clear()).contains("no species"));
    assert!(refused(&|s| s.species[0].share = 0.0).contains("no species"));
    assert!(
        refused(&|s| s.species[0].name = "oka".into())
            .contains("species 1: there is no species `oka`; is `oak` meant?")
    );
    assert!(refused(&|s| s.density_ha = f64::NAN).contains("density_ha must be"));
    assert!(refused(&|s| s.density_ha = -3.0).contains("density_ha must be"));
    assert!(refused(&|s| s.species[0].slope_deg = Some([30.0, 5.0])).contains("slope_deg goes from 30 to 5"));
    assert!(
        refused(&|s| s.keep_out = vec![vec![[0.0, 0.0], [1.0, 1.0]]]).contains("keep_out needs 3 corners")
    );
    assert!(
        refused(&|s| s.outline = vec![[0.0, 0.0], [f64::NAN, 1.0], [1.0, 1.0]]).contains("outline needs")
    );
    let all = vec![[-99.0, -99.0], [99.0, -99.0], [99.0, 99.0], [-99.0, 99.0]];
    assert!(refused(&|s| s.keep_out = vec![all.clone()]).contains("no tree stands"));
    assert!(refused(&|s| s.species[0].height_m = Some([500.0, 900.0])).contains("no tree stands"));
    assert!(
        refused(&|s| s.area_m = [100_000.0, 100_000.0])
            .contains("1,000,000,000 trees of a stand are more than the limit")
    );
    assert!(
        refused(&|s| s.masks = vec![crate::MaskSpec::default()]).contains("names 1 masks, and 0 were given")
    );
    let budget = Budget { times: 1e-5, ..Budget::default() };
    let small = Run { budget, ..Run::plain() };
    assert!(grow_stand(&pine(50.0, 1000.0, 10), &Ground::Flat, Seed::new(1), &small).is_err());
    let cancel = CancelToken::new();
    cancel.cancel();
    let stopped = Run { cancel: &cancel, ..Run::plain() };
    let fault = grow_stand(&pine(50.0, 1000.0, 10), &Ground::Flat, Seed::new(1), &stopped).unwrap_err();
    assert_eq!(fault, ForestError::Cancelled(Cancelled));
}

#[test]
fn a_larger_area_keeps_its_trees() {
    let small = grow(&pine(60.0, 500.0, 0));
    let large = grow(&pine(120.0, 500.0, 0));
    let places = |g: &GrownStand| g.stand.trees.iter().map(|t| t.foot_m).collect::<Vec<_>>();
    let kept = places(&large);
    assert!(places(&small).iter().all(|p| kept.contains(p)));
}

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig::with_cases(24))]

    /// For any spec, trees are sound, apart and within; or the stand is refused.
    #[test]
    fn every_stand_is_sound(
        side in 1.0..80.0_f64, density in 0.01..20_000.0_f64, years in 0..60_u32, step in 1..20_u32,
        species in proptest::collection::vec((0..50_usize, 0.0..3.0_f64, 0.0..2.0_f64), 1..4), seed in 0..1000_u64,
    ) {
        let mut spec = pine(side, density.min(3000.0 * 1e4 / (side * side)), years);
        spec.step_years = step;
        spec.species = species.into_iter().map(|(k, share, seedlings)| SpeciesSpec {
            name: Allometry::all()[k % Allometry::all().len()].preset.into(), share, seedlings, ..SpeciesSpec::default()
        }).collect();
        if let Ok(grown) = grow_stand_on(&spec, &Site { ground: &Ground::Flat, masks: &[] }, Seed::new(seed), &Run::plain()) {
            proptest::prop_assert_eq!(grown.stand.validate().next(), None);
            let trees = &grown.stand.trees;
            for (i, a) in trees.iter().enumerate() {
                proptest::prop_assert!(a.foot_m.abs().max_element() <= 0.5 * side);
                for b in &trees[..i] {
                    proptest::prop_assert!(a.foot_m.distance(b.foot_m) >= 0.5 * (a.dbh_m + b.dbh_m));
                }
            }
            proptest::prop_assert_eq!(grown.history.last().unwrap().trees, trees.len());
            for pair in grown.history.windows(2) {
                proptest::prop_assert_eq!(pair[0].trees + pair[1].came, pair[1].trees + pair[1].died);
            }
        }
    }
}

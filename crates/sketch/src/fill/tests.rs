//! Contours of many forms, filled and judged.

use base::ops::{TAU, sin_cos};
use proptest::prelude::*;
use reading::{Attachment, AxisReading};

use super::*;

/// A crown's contour by name, ink coordinates, with the trunk below it ending at `trunk_top`.
pub(super) fn contour(name: &str) -> (Vec<DVec2>, f64) {
    let ring = |n: u32, f: &dyn Fn(f64) -> (f64, f64)| -> Vec<DVec2> {
        (0..n).map(|i| f(TAU * f64::from(i) / f64::from(n))).map(|(x, y)| DVec2::new(x, y)).collect()
    };
    let at = |r: f64, a: f64, rx: f64, ry: f64| {
        let (s, c) = sin_cos(a);
        (0.5 + rx * r * c, 0.6 + ry * r * s)
    };
    match name {
        "round" => (ring(80, &|a| at(1.0, a, 0.28, 0.28)), 0.34),
        "flat" => (ring(80, &|a| at(1.0, a, 0.45, 0.16)), 0.5),
        "tall" => (ring(80, &|a| at(1.0, a, 0.13, 0.34)), 0.3),
        "lobed" => (
            ring(200, &|a| {
                let (s, _) = sin_cos(3.5 * a);
                at(0.82 + 0.2 * s.abs(), a, 0.3, 0.26)
            }),
            0.36,
        ),
        "cone" => ([(0.25, 0.2), (0.75, 0.2), (0.5, 0.95)].map(|(x, y)| DVec2::new(x, y)).to_vec(), 0.2),
        "concave" => (
            // A crescent that opens downwards around the trunk.
            [
                (0.2, 0.35),
                (0.3, 0.33),
                (0.36, 0.5),
                (0.5, 0.6),
                (0.64, 0.5),
                (0.7, 0.33),
                (0.8, 0.35),
                (0.78, 0.6),
                (0.65, 0.8),
                (0.5, 0.86),
                (0.35, 0.8),
                (0.22, 0.6),
            ]
            .map(|(x, y)| DVec2::new(x, y))
            .to_vec(),
            0.62,
        ),
        "bush" => (ring(80, &|a| at(1.0, a, 0.4, 0.25)), 0.36),
        _ => (ring(60, &|a| at(1.0, a, 0.22, 0.3)), 0.3),
    }
}

pub(super) struct Made {
    pub(super) plant: Plant,
    pub(super) outlines: Vec<Vec<DVec2>>,
    pub(super) drawn: usize,
    pub(super) report: Report,
}

pub(super) fn grown(outline: Vec<DVec2>, kind: RegionKind, lines: &[Vec<DVec2>], spec: &SketchSpec) -> Made {
    grown_again(outline, kind, lines, spec, (1, None))
}

fn leaf_of(length: f64) -> Shape {
    let mut blade = BladeForm::Ovate.blade();
    blade.outline.iter_mut().chain(&mut blade.midrib).for_each(|p| *p *= length);
    Shape::Blade(blade)
}

/// Grows a contour as [`grown`] does, with another seed, and with a drawn leaf of some length in metres.
fn grown_again(
    outline: Vec<DVec2>,
    kind: RegionKind,
    lines: &[Vec<DVec2>],
    spec: &SketchSpec,
    (seed, leaf): (u64, Option<f64>),
) -> Made {
    let map = PlantMap { metres_per_ink: 8.0, origin_ink: DVec2::new(0.5, 0.0) };
    let mut plant = Plant::default();
    let mut axes = Vec::new();
    let mut reading = Reading { woody: true, ..Reading::default() };
    for (i, line) in lines.iter().enumerate() {
        let points: Vec<DVec3> = line.iter().map(|&p| map.plant_at_depth(p, 0.0)).collect();
        // Every line but the first starts at a node of the first.
        let bearer = (i > 0).then(|| {
            let nodes = plant.axis(AxisId::new(0)).node_ids();
            let near = nodes.min_by(|a, b| {
                let d = |n: &plant::NodeId| plant.nodes.position[n.index()].distance(points[0]);
                d(a).total_cmp(&d(b))
            });
            near.expect("the first line has nodes")
        });
        let mut points = points;
        if let Some(b) = bearer {
            points[0] = plant.nodes.position[b.index()];
        }
        axes.push(Some(plant.add_axis(AxisKind::Branch, bearer, 100 + i as u64, &points, None)));
        reading.axes.push(AxisReading {
            points: line.clone(),
            kind: AxisKind::Branch,
            bearer: (i > 0).then_some(Attachment { axis: 0, at: 0.0 }),
            half_width: Vec::new(),
            source: None,
        });
    }
    let drawn = plant.axes.len();
    let metres: Vec<DVec2> = outline.iter().map(|&p| map.plant_from_ink(p)).collect();
    let bearers = (0..lines.len()).collect();
    reading.regions.push(RegionReading { outline, kind, bearers, source: None, color: None });
    let templates: Vec<(ShapeId, Option<u32>)> =
        leaf.map(|length| (plant.add_shape(leaf_of(length)), None)).into_iter().collect();
    let ctx = FillContext {
        spec,
        seed: Seed::new(seed),
        map,
        axis_of_reading: &axes,
        templates: &templates,
        height_m: 8.0,
        woody: true,
        coloured: false,
    };
    let mut report = Report::default();
    fill(&mut plant, &reading, &ctx, &mut KeptBodies::default(), &Run::plain(), &mut report)
        .expect("nobody cancels");
    // For a crown drawn in one line with its trunk: without the part below the neck, which is the way to it.
    let metres = body(metres.clone(), kind).map_or(metres, |(outline, _)| outline);
    Made { plant, outlines: vec![metres], drawn, report }
}

pub(super) fn line(a: (f64, f64), b: (f64, f64), n: u32) -> Vec<DVec2> {
    let (a, b) = (DVec2::new(a.0, a.1), DVec2::new(b.0, b.1));
    (0..=n).map(|i| a.lerp(b, f64::from(i) / f64::from(n))).collect()
}

pub(super) fn tree(name: &str, spec: &SketchSpec) -> Made {
    let (outline, top) = contour(name);
    grown(
        outline,
        RegionKind::Crown,
        &[line((0.5, if name == "bush" { top - 0.01 } else { 0.0 }), (0.5, top), 30)],
        spec,
    )
}

const CROWNS: [&str; 8] = ["round", "flat", "tall", "lobed", "cone", "concave", "bush", "egg"];

fn inside(outline: &[DVec2], p: DVec2) -> bool {
    geom::contains(outline, p)
}

/// Checks that every grown node, except the bearers' own, and every leaf's root lies in the contour as seen from the
/// front.
fn check_inside(made: &Made, what: &str) {
    let plant = &made.plant;
    for axis in &plant.axes[made.drawn..] {
        let mut entered = false;
        for node in axis.node_ids().skip(1) {
            let p = plant.nodes.position[node.index()].truncate();
            let now = inside(&made.outlines[0], p);
            // If the drawn trunk ends below the crown, the way to the contour is outside it.
            assert!(now || !entered, "{what}: a twig leaves the contour at {p}");
            entered |= now;
        }
    }
    for organ in &plant.organs {
        let p = organ.frame.origin.truncate();
        assert!(inside(&made.outlines[0], p), "{what}: a leaf is rooted outside at {p}");
    }
}

#[test]
fn crowns_of_all_forms_become_leafy_trees() {
    for name in CROWNS {
        let made = tree(name, &SketchSpec::default());
        assert_eq!(made.plant.validate().next(), None, "{name}");
        assert!(made.report.warnings.is_empty(), "{name}: {:?}", made.report.warnings);
        let (axes, leaves) = (made.plant.axes.len(), made.plant.organs.len());
        assert!((60..1_200).contains(&axes), "{name}: {axes} axes");
        assert!((400..12_000).contains(&leaves), "{name}: {leaves} leaves");
        // On a tree of 8 m they have the length of natural leaves, or of a conifer's sprays.
        let mean = made
            .plant
            .organs
            .iter()
            .filter_map(|o| Some(o.scale * made.plant.shapes[o.shape.index()].length()?))
            .sum::<f64>()
            / leaves as f64;
        assert!((0.05..0.4).contains(&mean), "{name}: leaves of {mean} m");
        check_inside(&made, name);
    }
}

#[test]
fn a_conifers_crown_bears_shoots_in_needles_and_no_other_does() {
    for name in CROWNS {
        let plant = tree(name, &SketchSpec::default()).plant;
        let needled = |o: &&plant::Organ| match &plant.shapes[o.shape.index()] {
            Shape::Blade(blade) => blade.needles.is_some(),
            _ => false,
        };
        let (shoots, all) = (plant.organs.iter().filter(needled).count(), plant.organs.len());
        assert_eq!(shoots, if name == "cone" { all } else { 0 }, "{name}: {shoots} of {all}");
    }
}

#[test]
fn a_crown_drawn_in_one_line_with_its_trunk_has_no_leaves_on_the_trunk() {
    let outline: Vec<DVec2> = [
        (0.45, 0.0),
        (0.55, 0.0),
        (0.55, 0.4),
        (0.75, 0.42),
        (0.85, 0.6),
        (0.75, 0.8),
        (0.5, 0.9),
        (0.25, 0.8),
        (0.15, 0.6),
        (0.25, 0.42),
        (0.45, 0.4),
    ]
    .map(|(x, y)| DVec2::new(x, y))
    .to_vec();
    let made =
        grown(outline, RegionKind::Crown, &[line((0.5, 0.0), (0.5, 0.45), 20)], &SketchSpec::default());
    assert_eq!(made.plant.validate().next(), None);
    let lowest = made.plant.organs.iter().map(|o| o.frame.origin.y).fold(f64::INFINITY, f64::min);
    assert!(lowest > 0.38 * 8.0, "a leaf at {lowest} m, the crown begins at 3.2 m");
    assert!(made.plant.organs.len() > 400, "{}", made.plant.organs.len());
}

#[test]
fn the_same_drawing_gives_the_same_plant() {
    let spec = SketchSpec::default();
    for name in ["round", "cone", "bush"] {
        assert_eq!(tree(name, &spec).plant.digest_hex(), tree(name, &spec).plant.digest_hex(), "{name}");
    }
}

#[test]
fn more_density_gives_more_twigs_and_leaves() {
    let count = |name: &str, density: f64| {
        let fill = FillSpec { density, ..FillSpec::default() };
        let made = tree(name, &SketchSpec { fill, ..SketchSpec::default() });
        (made.plant.axes.len(), made.plant.organs.len())
    };
    for name in ["round", "cone"] {
        let counts: Vec<_> = [0.4, 1.0, 2.5].map(|d| count(name, d)).to_vec();
        assert!(counts.windows(2).all(|w| w[0].0 < w[1].0 && w[0].1 < w[1].1), "{name}: {counts:?}");
    }
}

#[test]
fn numbers_out_of_range_are_tamed() {
    let fill = FillSpec {
        set: None,
        contour_pull: f64::NAN,
        bearer_pull: -3.0,
        memory: 1e300,
        density: f64::INFINITY,
        tropism: 9.0,
    };
    let made = tree("round", &SketchSpec { fill, ..SketchSpec::default() });
    assert_eq!(made.plant.validate().next(), None);
    check_inside(&made, "wild numbers");
}

#[test]
fn a_contour_without_area_is_left_empty_with_a_warning() {
    let flat: Vec<DVec2> = line((0.1, 0.5), (0.9, 0.5), 20);
    for outline in [flat, vec![], vec![DVec2::ZERO; 5], vec![DVec2::NAN; 4]] {
        for kind in [RegionKind::Crown, RegionKind::Leaves, RegionKind::Twigs] {
            let made =
                grown(outline.clone(), kind, &[line((0.5, 0.0), (0.5, 0.9), 20)], &SketchSpec::default());
            assert_eq!((made.plant.axes.len(), made.plant.organs.len()), (1, 0));
            assert_eq!(made.report.warnings.len(), 1);
        }
    }
}

#[test]
fn branch_contours_grow_twigs_and_leaf_contours_leaves() {
    let ring: Vec<DVec2> = (0..60)
        .map(|i| {
            let (s, c) = sin_cos(TAU * f64::from(i) / 60.0);
            DVec2::new(0.6 + 0.35 * c, 0.7 + 0.2 * s + 0.1 * c)
        })
        .collect();
    let lines = [line((0.5, 0.0), (0.5, 0.9), 60), line((0.5, 0.4), (0.9, 0.85), 40)];
    let twigs = grown(ring.clone(), RegionKind::Twigs, &lines, &SketchSpec::default());
    check_inside(&twigs, "twigs");
    // The branch contours of He and Cheng (2021) hold about eleven twigs (Table 1, sketches a and f).
    assert!((8..40).contains(&twigs.plant.axes.len()), "{}", twigs.plant.axes.len());
    assert_eq!((twigs.plant.validate().next(), twigs.plant.organs.len()), (None, 0));
    let leaves = grown(ring, RegionKind::Leaves, &lines, &SketchSpec::default());
    check_inside(&leaves, "leaves");
    assert!((15..120).contains(&leaves.plant.organs.len()), "{}", leaves.plant.organs.len());
    assert_eq!(leaves.plant.validate().next(), None);
}

#[test]
fn the_three_coefficient_sets_of_the_paper_bend_twigs_to_the_contour_more_and_more() {
    // Fig 2 (a) to (c): the more the contour pulls, the steeper twigs leave their bearer.
    let ring: Vec<DVec2> = (0..60)
        .map(|i| {
            let (s, c) = sin_cos(TAU * f64::from(i) / 60.0);
            DVec2::new(0.5 + 0.2 * c, 0.6 + 0.35 * s)
        })
        .collect();
    let mean_rise = |contour_pull: f64, bearer_pull: f64| {
        let fill = FillSpec { contour_pull, bearer_pull, tropism: 0.0, ..FillSpec::default() };
        let spec = SketchSpec { fill, ..SketchSpec::default() };
        let made = grown(ring.clone(), RegionKind::Twigs, &[line((0.5, 0.0), (0.5, 0.9), 80)], &spec);
        let first: Vec<f64> = made.plant.axes[made.drawn..]
            .iter()
            .filter(|a| a.order == 1)
            .take(25)
            .map(|a| {
                let p = &made.plant.nodes.position[a.nodes.start as usize..a.nodes.end as usize];
                (p[1] - p[0]).normalize().y
            })
            .collect();
        first.iter().sum::<f64>() / first.len() as f64
    };
    let rises = [mean_rise(0.45, 0.45), mean_rise(0.55, 0.35), mean_rise(0.65, 0.25)];
    assert!(rises[0] > rises[1] && rises[1] > rises[2], "{rises:?}");
}

/// An oval round a stem, `size` times as large as the largest that finds room.
fn oval(size: f64) -> Vec<DVec2> {
    let at = |i| {
        let (s, c) = sin_cos(TAU * f64::from(i) / 60.0);
        DVec2::new(0.5 + 0.4 * size * c, 0.55 + 0.4 * size * s)
    };
    (0..60).map(at).collect()
}

#[test]
fn a_contour_of_four_times_the_area_holds_four_times_as_many() {
    let stem = [line((0.5, 0.0), (0.5, 0.9), 90)];
    for seed in 1..=12 {
        for kind in [RegionKind::Twigs, RegionKind::Leaves] {
            let count = |size: f64| {
                let made = grown_again(oval(size), kind, &stem, &SketchSpec::default(), (seed, None));
                check_inside(&made, "oval");
                if kind == RegionKind::Twigs {
                    made.plant.axes.len() - made.drawn
                } else {
                    made.plant.organs.len()
                }
            };
            let counts = [0.25, 0.5, 1.0].map(count);
            for pair in counts.windows(2) {
                let ratio = pair[1] as f64 / pair[0] as f64;
                assert!((2.4..6.0).contains(&ratio), "{kind:?}, seed {seed}: {counts:?}");
            }
        }
    }
}

#[test]
fn smaller_leaves_are_more_leaves() {
    let stem = [line((0.5, 0.0), (0.5, 0.9), 90)];
    for seed in 1..=12 {
        let count = |length: f64| {
            let leaf = (seed, Some(length));
            let made = grown_again(oval(0.6), RegionKind::Leaves, &stem, &SketchSpec::default(), leaf);
            made.plant.organs.len()
        };
        let counts = [0.8, 0.4, 0.2].map(count);
        let more = |w: &[usize]| (2.4..6.0).contains(&(w[1] as f64 / w[0] as f64));
        assert!(counts.windows(2).all(more), "seed {seed}: {counts:?}");
    }
}

#[test]
fn a_twig_grows_to_the_nearest_point_of_the_contour() {
    // A tall box: from any place of a stem in its middle the nearest point of the contour is level with it, at its
    // side.
    let tall: Vec<DVec2> =
        [(0.3, 0.1), (0.7, 0.1), (0.7, 0.95), (0.3, 0.95)].map(|(x, y)| DVec2::new(x, y)).to_vec();
    for (contour_pull, bearer_pull, rise) in [(1.0, 0.0, 0.0), (0.5, 0.5, 1.0), (0.65, 0.25, 0.25 / 0.65)] {
        let fill = FillSpec { contour_pull, bearer_pull, memory: 0.0, tropism: 0.0, ..FillSpec::default() };
        let spec = SketchSpec { fill, ..SketchSpec::default() };
        let stem = [line((0.5, 0.0), (0.5, 0.94), 94)];
        for seed in 1..=12 {
            let made = grown_again(tall.clone(), RegionKind::Twigs, &stem, &spec, (seed, None));
            let mut seen = 0;
            for axis in made.plant.axes[made.drawn..].iter().filter(|a| a.order == 1) {
                let p = &made.plant.nodes.position[axis.nodes.start as usize..axis.nodes.end as usize];
                // The ends of the box are as near as its sides there; twigs that have turned to the viewer seem steep.
                let way = p[p.len() - 1] - p[0];
                if p[0].y < 2.4 || p[p.len() - 1].y > 6.0 || way.z.abs() > 0.3 * way.x.abs() {
                    continue;
                }
                seen += 1;
                let slope = way.y / way.x.abs();
                assert!((slope - rise).abs() < 0.2 + 0.25 * rise, "seed {seed}: {slope} for {rise}");
                // It ends near the side of the contour.
                let end = p[p.len() - 1].x.abs();
                assert!((1.2..1.6).contains(&end), "seed {seed}: ends {end} m off the middle");
            }
            assert!(contour_pull < 1.0 || seen > 0, "seed {seed}");
        }
    }
}

#[test]
fn named_sets_are_the_coefficients_of_the_paper() {
    let stem = [line((0.5, 0.0), (0.5, 0.9), 90)];
    let digest = |fill: FillSpec| {
        let spec = SketchSpec { fill, ..SketchSpec::default() };
        grown(oval(0.6), RegionKind::Twigs, &stem, &spec).plant.digest_hex()
    };
    let mut seen = Vec::new();
    for set in PullSet::ALL {
        let [contour_pull, bearer_pull, memory] = set.coefficients();
        let named = digest(FillSpec { set: Some(set), ..FillSpec::default() });
        let numbers = FillSpec { contour_pull, bearer_pull, memory, ..FillSpec::default() };
        assert_eq!(named, digest(numbers), "{set:?}");
        assert!(!seen.contains(&named), "{set:?} is like another");
        seen.push(named);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    #[test]
    fn any_simple_contour_gives_a_sound_plant(
        radii in proptest::collection::vec(0.02_f64..0.45, 3..24),
        squash in 0.1_f64..1.0,
        foot in -0.3_f64..1.2,
        top in 0.0_f64..1.0,
        kind in 0_usize..3,
    ) {
        // Star-shaped polygons: simple by construction, with deep notches.
        let n = radii.len() as f64;
        let outline: Vec<DVec2> = radii.iter().enumerate().map(|(i, r)| {
            let (s, c) = sin_cos(TAU * i as f64 / n);
            DVec2::new(0.5 + r * c, 0.55 + r * s * squash)
        }).collect();
        let kind = [RegionKind::Twigs, RegionKind::Leaves, RegionKind::Crown][kind];
        let made = grown(outline, kind, &[line((foot, 0.0), (0.5, top), 25)], &SketchSpec::default());
        prop_assert_eq!(made.plant.validate().next(), None);
        check_inside(&made, "star");
        prop_assert!(made.plant.axes.len() <= crown::MOST_TWIGS + 1_000);
        prop_assert!(made.plant.organs.len() <= leaves::MOST_LEAVES);
    }
}

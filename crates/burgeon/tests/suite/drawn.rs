//! Plants drawn as a person draws them.

use burgeon::glam::DVec2;
use burgeon::{
    CancelToken, DrawnKind, FlowerOptions, NOTHING, Run, Seed, TreeOptions, TreeSpec, drawing_of, drawn,
    make_flower, make_tree,
};

/// Number of directions in which the reach of a crown is drawn.
const SECTORS: usize = 48;

#[test]
fn a_flower_is_drawn_by_its_outlines_those_behind_first() {
    let spec = bloom::preset("lily").expect("a preset");
    let (day, options) = ((spec.opening_days, &spec.own_law()), FlowerOptions::default());
    let made = make_flower("lily", &spec, day, &options, Seed::new(1), &Run::plain()).expect("a flower");
    let lines = drawn((&made.plant, &made.model, &made.layout), &Run::plain()).expect("lines");
    let of = |kind| lines.iter().filter(|l| l.kind == kind).count();
    assert!(of(DrawnKind::Blade) >= 5 && of(DrawnKind::Axis) >= 1 && of(DrawnKind::Crown) == 0);
    for line in lines.iter().filter(|l| l.kind == DrawnKind::Blade) {
        assert_eq!(line.points.first(), line.points.last(), "an outline is closed");
    }
}

#[test]
fn a_tree_in_leaf_is_its_trunk_and_its_crown() {
    let spec = TreeSpec::default();
    let made = make_tree(&spec, Seed::new(3), &TreeOptions::default(), &Run::plain()).expect("a tree");
    let lines = drawn((&made.grown.plant, &made.model, &made.layout), &Run::plain()).expect("lines");
    assert_eq!(lines.first().map(|l| (l.kind, l.row)), Some((DrawnKind::Axis, 0)));
    let crown = lines.last().expect("a crown");
    assert_eq!((crown.kind, crown.row, crown.points.len()), (DrawnKind::Crown, NOTHING, SECTORS + 1));
    let drawing = drawing_of("a tree", lines.iter().map(|l| (l.kind.word(), l.points.clone())));
    assert_eq!(drawing.strokes.len(), lines.len());
    assert_eq!(drawing.layers.iter().map(|l| &*l.name).collect::<Vec<_>>(), ["axis", "crown"]);
}

#[test]
fn a_trunk_ends_behind_dense_foliage_and_goes_through_a_sparse_one() {
    // Computes the share of the crown's height up to which the trunk is drawn.
    let seen = |larger: f64| {
        let mut spec = TreeSpec::default();
        spec.leaves.length_m *= larger;
        let made = make_tree(&spec, Seed::new(3), &TreeOptions::default(), &Run::plain()).expect("a tree");
        let lines = drawn((&made.grown.plant, &made.model, &made.layout), &Run::plain()).expect("lines");
        let crown = lines.last().expect("a crown");
        let top = |points: &[DVec2]| points.iter().map(|p| p.y).fold(0.0, f64::max);
        let foot = crown.points.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
        (top(&lines[0].points) - foot) / (top(&crown.points) - foot)
    };
    let (dense, sparse) = (seen(3.0), seen(1.0));
    assert!((0.0..0.4).contains(&dense) && sparse > 0.6, "{dense} {sparse}");
}

#[test]
fn what_is_stopped_draws_nothing() {
    let made = make_tree(&TreeSpec::default(), Seed::new(3), &TreeOptions::default(), &Run::plain());
    let made = made.expect("a tree");
    let cancel = CancelToken::new();
    cancel.cancel();
    let run = Run { cancel: &cancel, ..Run::plain() };
    assert!(drawn((&made.grown.plant, &made.model, &made.layout), &run).is_err());
}

//! Results left for later equal those computed at once.

use burgeon::glam::DVec2;
use burgeon::ink::Drawing;
use burgeon::{ItemReport, Run};
use workspace::Workspace;

/// Draws this many parallel lines.
fn drawn(count: u32, later: bool) -> (Workspace, ItemReport) {
    let mut workspace = Workspace::default();
    workspace.measure_later(later);
    let line = |k: u32| -> Vec<DVec2> {
        let foot = DVec2::new(f64::from(k % 40), f64::from(k / 40));
        (0..9).map(|i| foot + DVec2::new(0.02 * f64::from(i * (i + k % 5)), 0.1 * f64::from(i))).collect()
    };
    for stroke in Drawing::from_polylines("", &(0..count).map(line).collect::<Vec<_>>()).strokes {
        workspace.add_stroke(stroke, Vec::new()).expect("a stroke");
    }
    let view = workspace.evaluate(&Run::plain()).expect("a plant");
    let item = view.plants[0].item.clone().expect("a report");
    (workspace, item)
}

#[test]
fn what_is_measured_later_is_what_is_measured_at_once() {
    let (mut at_once, whole) = drawn(600, false);
    assert!(whole.fidelity.reprojection_mean.is_some(), "there are lines to compare");
    assert!(at_once.measure(&Run::plain()).expect("not cancelled").is_none(), "nothing is left");
    let (mut workspace, first) = drawn(600, true);
    assert_eq!((first.fidelity.reprojection_mean, &first.digest), (None, &whole.digest));
    let view = workspace.measure(&Run::plain()).expect("not cancelled").expect("something was left");
    let plant = &view.plants[0];
    assert!(!plant.fresh, "its meshes are known");
    assert_eq!(plant.item.as_ref(), Some(&whole));
    assert!(workspace.measure(&Run::plain()).expect("not cancelled").is_none(), "once");
}

#[test]
fn a_drawing_of_few_strokes_is_measured_at_once() {
    let (_, item) = drawn(30, true);
    assert!(item.fidelity.reprojection_mean.is_some());
}

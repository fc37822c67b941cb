//! Motion of plant and organs between scans, for reports and people.

use burgeon::bloom::{OrganStep, PoseDoubt, PoseStep, RigidMotion};
use serde::Serialize;

/// A rotation about an axis and a translation of its centre.
#[derive(Debug, Serialize)]
struct Turn {
    turn_deg: f64,
    /// Unit axis of the rotation, +Y up.
    axis: [f64; 3],
    move_mm: f64,
}

impl From<&RigidMotion> for Turn {
    fn from(m: &RigidMotion) -> Self {
        Self { turn_deg: m.angle().to_degrees(), axis: m.axis().to_array(), move_mm: m.shift() * 1e3 }
    }
}

#[derive(Debug, Serialize)]
struct OrganTold {
    organ: String,
    /// Rotation about its joint, in the frame of the plant.
    #[serde(flatten)]
    pose: Turn,
    /// Growth in size, 1 for none.
    scale: f64,
    /// Growth in shape: the residual after motion and size.
    shape_mm: f64,
    residual_mm: f64,
    back_residual_mm: f64,
}

impl From<&OrganStep> for OrganTold {
    fn from(o: &OrganStep) -> Self {
        Self {
            organ: o.organ.clone(),
            pose: Turn::from(&o.pose),
            scale: o.scale,
            shape_mm: o.shape_m * 1e3,
            residual_mm: o.residual.to_model.mean * 1e3,
            back_residual_mm: o.residual.to_scan.mean * 1e3,
        }
    }
}

/// Changes from one scan to the next.
#[derive(Debug, Serialize)]
pub(crate) struct PoseReport {
    from_day: f64,
    to_day: f64,
    /// Motion of the whole plant about its foot; `None` where fewer than two organs are on both days.
    plant: Option<Turn>,
    organs: Vec<OrganTold>,
    appeared: Vec<String>,
    vanished: Vec<String>,
}

impl From<&PoseStep> for PoseReport {
    fn from(s: &PoseStep) -> Self {
        Self {
            from_day: s.from_day,
            to_day: s.to_day,
            plant: (s.organs.len() > 1).then(|| Turn::from(&s.plant)),
            organs: s.organs.iter().map(OrganTold::from).collect(),
            appeared: s.appeared.clone(),
            vanished: s.vanished.clone(),
        }
    }
}

/// Returns a warning for each step between scans whose organs may have been confused.
pub(crate) fn doubts(steps: &[PoseStep]) -> Vec<String> {
    let told = |step: &PoseStep| {
        let days = format!("from day {} to {}", step.from_day, step.to_day);
        let way_out = "name organs by hand (`organ` and `seed` in a [[stage]]), or turn the scan as the one before stands";
        Some(match step.doubt()? {
            PoseDoubt::Plant { turn_deg } => format!(
                "{days} the plant seems to have turned by {turn_deg:.0} degrees: if its pot was not turned so far, organs were \
                 taken for one another; {way_out}"
            ),
            PoseDoubt::Organs { organ, turn_deg } => format!(
                "{days} organs turned far by themselves, {organ} by {turn_deg:.0} degrees: they may have been taken for one \
                 another, or the pot was turned by more than 60 degrees; {way_out}"
            ),
        })
    };
    steps.iter().filter_map(told).collect()
}

impl PoseReport {
    /// Returns lines for people: one for the plant, one for each organ.
    pub(crate) fn lines(&self) -> Vec<String> {
        let mut head = format!("day {} to {}", self.from_day, self.to_day);
        if let Some(p) = &self.plant {
            head += &format!(
                ": the plant turned by {:.1} degrees, its foot moved {:.1} mm",
                p.turn_deg, p.move_mm
            );
        }
        for (what, names) in [("new", &self.appeared), ("gone", &self.vanished)] {
            if !names.is_empty() {
                head += &format!("; {what}: {}", names.join(", "));
            }
        }
        let organ = |o: &OrganTold| {
            format!(
                "  {}: turned by {:.1} degrees, joint moved {:.1} mm, size x {:.3}, shape changed by {:.2} mm",
                o.organ, o.pose.turn_deg, o.pose.move_mm, o.scale, o.shape_mm
            )
        };
        core::iter::once(head).chain(self.organs.iter().map(organ)).collect()
    }
}

//! Prop roots, which arch from the stem down to the ground, as in mangroves.
//!
//! `Skeleton + PropSpec -> Skeleton with props, its stem narrower below them`

use base::ops::{self, FRAC_PI_2, PI};
use base::{Draw, Seed};
use glam::DVec3;

use crate::wood::{PropSpec, boles, main_children, radii};
use crate::{JointId, Skeleton, WoodSpec};

/// Key under which a seed draws props.
const PROPS: u64 = 0x70_726f_7073;
/// Joints of a quarter of an arch.
const STEPS: u32 = 9;
/// Thickness of the foot of a stem that stands on props, relative to that above them.
const FOOT: f64 = 0.4;
/// Depth to which props reach into the ground, in their radii.
const SUNK: f64 = 2.0;

/// Adds the props of each tree that has grown to a share of its height. They ignore obstacles.
pub(crate) fn add_props(skeleton: &mut Skeleton, wood: &WoodSpec, grown: f64, seed: Seed) {
    let spec = &wood.props;
    if spec.count == 0 || skeleton.is_empty() {
        return;
    }
    let radius = radii(skeleton, wood);
    let main = main_children(skeleton, &radius);
    let on_bole = boles(skeleton, &main);
    let roots: Vec<usize> = (0..skeleton.len()).filter(|&j| skeleton.parent[j].is_none()).collect();
    for (root, i) in roots.into_iter().zip(0_u64..) {
        let ground = skeleton.position[root].y;
        let bole: Vec<usize> = core::iter::successors(Some(root), |&j| main[j].map(JointId::index))
            .take_while(|&j| on_bole[j])
            .collect();
        let top = bole.iter().map(|&j| skeleton.position[j].y - ground).fold(0.0, f64::max);
        let rise = (grown * spec.rise_m).min(top);
        // The stem keeps the thickness that its crown needs: props do not feed it.
        for &j in &bole {
            let up = ((skeleton.position[j].y - ground) / rise.max(1e-9)).clamp(0.0, 1.0);
            skeleton.radius_m[j] = radius[j] * ops::lerp(FOOT, 1.0, up);
        }
        if rise <= 0.0 || bole.len() < 2 {
            continue;
        }
        let arch = Arch { ground, grown, rise, spec };
        for k in 0..u64::from(spec.count) {
            arch.add(skeleton, &bole, (k, spec.count), seed.child(PROPS).child(i).child(k));
        }
    }
}

/// Common data of the arches of one tree.
struct Arch<'a> {
    ground: f64,
    grown: f64,
    rise: f64,
    spec: &'a PropSpec,
}

impl Arch<'_> {
    fn add(&self, skeleton: &mut Skeleton, bole: &[usize], (k, count): (u64, u32), seed: Seed) {
        let mut draw = seed.stream(Draw::Habit);
        #[expect(clippy::cast_precision_loss, reason = "at most 200")]
        let share = (k as f64 + 0.3 + 0.7 * draw.uniform()) / f64::from(count);
        let height = self.ground + self.rise * share.min(1.0);
        let off = |j: usize| (skeleton.position[j].y - height).abs();
        let Some(from) = bole.iter().copied().reduce(|a, b| if off(b) < off(a) { b } else { a }) else {
            return;
        };
        // The golden angle spreads them around the stem.
        let turn =
            f64::from(u32::try_from(k).unwrap_or(0)) * PI * (3.0 - 5.0_f64.sqrt()) + 0.9 * draw.uniform();
        let reach = self.spec.reach_m * self.grown * (0.35 + 0.65 * share) * (0.6 + 0.8 * draw.uniform());
        let radius = self.spec.radius_m * (0.4 + 0.6 * self.grown) * (0.7 + 0.6 * draw.uniform());
        let lift = 0.25 * draw.uniform();
        let joints = self.quarter(skeleton, JointId::new(from), turn, (reach, lift), radius);
        if draw.uniform() < self.spec.fork {
            let half = joints[joints.len() / 2 - 1];
            let aside = turn + 1.6 * (draw.uniform() - 0.5);
            let further = reach * (0.4 + 0.5 * draw.uniform());
            self.quarter(skeleton, half, aside, (further, 0.1), 0.75 * radius);
        }
    }

    /// Makes a quarter of an ellipse from a joint down to the ground, slightly raised at its start.
    fn quarter(
        &self,
        skeleton: &mut Skeleton,
        from: JointId,
        turn: f64,
        (reach, lift): (f64, f64),
        radius: f64,
    ) -> Vec<JointId> {
        let foot = skeleton.position[from.index()];
        let birth = skeleton.birth[from.index()];
        let (sin, cos) = ops::sin_cos(turn);
        let out = DVec3::new(cos, 0.0, sin);
        let fall = foot.y - self.ground + SUNK * radius;
        let mut joint = from;
        let mut joints = Vec::new();
        for step in 1..=STEPS {
            let t = f64::from(step) / f64::from(STEPS);
            let (s, c) = ops::sin_cos(t * FRAC_PI_2);
            let raised = lift * fall * ops::sin(t * PI) * (1.0 - t);
            let at = DVec3::new(foot.x, self.ground - SUNK * radius + fall * c + raised, foot.z)
                + out * (reach * s);
            joint = skeleton.push(at, joint, birth);
            skeleton.radius_m[joint.index()] = radius * ops::lerp(1.0, 0.75, t);
            joints.push(joint);
        }
        joints
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn props_come_down_all_round_and_leave_the_stem_above_as_it_was() {
        let mut full = Skeleton::default();
        let mut at = full.push_root(DVec3::ZERO, 0);
        for y in 1..=30 {
            at = full.push(DVec3::Y * (0.2 * f64::from(y)), at, 1);
            full.radius_m[at.index()] = 0.1;
        }
        let props = PropSpec { count: 24, rise_m: 2.0, ..PropSpec::default() };
        let wood = WoodSpec { props, ..WoodSpec::default() };
        let mut whole = full.clone();
        add_props(&mut whole, &wood, 1.0, Seed::new(1));
        assert_eq!(whole.validate().count(), 0);
        let feet: Vec<DVec3> = whole.position[full.len()..].iter().copied().filter(|p| p.y < 0.0).collect();
        assert!(feet.len() >= 24 && feet.iter().all(|p| p.y > -0.2), "{}", feet.len());
        for [x, z] in [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]] {
            assert!(feet.iter().filter(|p| p.x * x > 0.0 && p.z * z > 0.0).count() > 2, "{x} {z}");
        }
        let highest = whole.position[full.len()..].iter().map(|p| p.y).fold(0.0, f64::max);
        assert!((1.5..2.4).contains(&highest), "{highest}");
        let r = &whole.radius_m;
        assert!(r[25] == 0.1 && r[1] < 0.06, "{} {}", r[25], r[1]);
        // Another seed has different ones, a young tree lower ones, and a count of 0 has none.
        let made = |life, seed| {
            let mut s = full.clone();
            add_props(&mut s, &wood, life, Seed::new(seed));
            s
        };
        assert!(made(1.0, 2) != whole);
        let young = made(0.3, 1);
        assert!(young.position[full.len()..].iter().all(|p| p.y < 1.2));
        let mut none = full.clone();
        add_props(&mut none, &WoodSpec::default(), 1.0, Seed::new(1));
        assert_eq!(none, full);
    }
}

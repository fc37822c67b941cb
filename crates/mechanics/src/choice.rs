//! Chooses the places of a plant that become joints.

use crate::line::{Line, Lines, Step};

/// Most joints of one axis: with this number the midpoint rule is within half a per cent (1 / 4 n^2).
const MOST_ON_AXIS: u32 = 8;

/// Highest natural frequency of a joint, radians a second: a stiffer limb would need a time step below half a
/// millisecond, and moves too little to be seen.
const FASTEST_RAD_S: f64 = 2000.0;

/// Least polar inertia of the limb that a joint moves, kg m2: that of a tenth of a gram at 3 mm. A lighter limb is not
/// worth a body of a simulator, and `MuJoCo` refuses 1e-15.
const LIGHTEST_KG_M2: f64 = 1e-9;

/// Place where an axis bends, with its compliance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bend {
    /// Arc length, metres.
    pub(crate) arc: f64,
    /// Integral of ds / (E I) over the run of the axis that the joint represents, radians per newton metre.
    pub(crate) compliance: f64,
}

/// Chooses the bends of each axis, at most `most` in all.
///
/// An axis with bending energy U under the reference load and n joints lacks U / 4 n^2 of it (the error of the midpoint
/// rule for a rod with a weight at its end), and U without any joint. Joints are given one by one to the axis whose
/// lacking energy falls most; all other axes are rigidly fixed to their bearers. Within an axis each joint represents a
/// run with an even share of the integral of (c F^2)^(1/3), where c is the compliance of a metre and F the geometric
/// mean of the weights borne there and at the foot: the division with the least error, also for a hand that pulls at
/// the tip. The joint stands at the run's centre of compliance, so that a run bends as far and as high up as the beam
/// does.
pub(crate) fn choose(lines: &Lines, most: u32) -> Vec<Vec<Bend>> {
    let mut counts = vec![0_u32; lines.all.len()];
    let energies: Vec<f64> =
        lines.all.iter().zip(&lines.steps).map(|(line, steps)| bending_energy(line, steps)).collect();
    let limits: Vec<u32> = lines.steps.iter().map(|steps| most_joints(steps)).collect();
    for _ in 0..most {
        let gains = (0..counts.len()).filter(|&row| counts[row] < limits[row]);
        let gains = gains.map(|row| (gain(energies[row], counts[row]), row)).filter(|(gain, _)| *gain > 0.0);
        // Among equal gains keep the first.
        let best = gains.reduce(|a, b| if b.0 > a.0 { b } else { a });
        let Some((_, row)) = best else { break };
        counts[row] += 1;
    }
    lines.steps.iter().zip(counts).map(|(steps, count)| bends(steps, count)).collect()
}

/// Returns the bending energy of an axis; 0 if it cannot bend.
fn bending_energy(line: &Line, steps: &[Step]) -> f64 {
    if line.is_buried || line.is_rigid {
        return 0.0;
    }
    steps.iter().map(|s| s.energy).sum()
}

/// Returns the decrease of the lacking energy with one more joint.
fn gain(energy: f64, joints: u32) -> f64 {
    let lacking = |n: u32| if n == 0 { energy } else { energy / (4.0 * f64::from(n * n)) };
    lacking(joints) - lacking(joints + 1)
}

/// Returns the most joints with which a limb is still slow enough. The highest frequency of a chain is about n^2 times
/// its own (Dunkerley 1894); a part between two joints has the inertia of its wood alone, however much the tip bears.
fn most_joints(steps: &[Step]) -> u32 {
    let most = |slowness: f64| {
        let most = (FASTEST_RAD_S * slowness.sqrt()).sqrt();
        if most.is_finite() { base::ops::whole(most.floor()).min(MOST_ON_AXIS) } else { 0 }
    };
    let bare = most(steps.iter().map(|s| s.bare_slowness).sum());
    most(steps.iter().map(|s| s.slowness).sum()).min(bare.max(1))
}

fn bends(steps: &[Step], count: u32) -> Vec<Bend> {
    let foot = steps.first().map_or(0.0, |s| s.borne);
    let weight = |s: &Step| {
        let length = s.to - s.from;
        base::ops::cbrt(s.compliance / length * s.borne * foot) * length
    };
    let whole: f64 = steps.iter().map(weight).sum();
    let mut runs = vec![Sums::default(); count as usize];
    let mut passed = 0.0;
    for step in steps {
        let own = weight(step);
        // A step that lies across a border is divided.
        let mut from = 0.0;
        while from < 1.0 && count > 0 {
            let at = (passed + own * from) / whole * f64::from(count);
            let run = base::ops::whole(at.floor()).min(count - 1);
            let border = f64::from(run + 1) / f64::from(count) * whole;
            let to =
                if run + 1 == count || own <= 0.0 { 1.0 } else { ((border - passed) / own).clamp(from, 1.0) };
            // Rounding may leave nothing of a step before a border.
            let to = if to - from < 1e-9 { (from + 1e-9).min(1.0) } else { to };
            let share = step.compliance * (to - from);
            let middle = base::ops::lerp(step.from, step.to, f64::midpoint(from, to));
            let sums = &mut runs[run as usize];
            sums.compliance += share;
            sums.first += share * middle;
            sums.slowness += step.slowness * (to - from);
            from = to;
        }
        passed += own;
    }
    runs.into_iter().filter(Sums::can_swing).map(Sums::bend).filter(|b| b.arc.is_finite()).collect()
}

/// Sums over the steps of a run.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    compliance: f64,
    /// Compliance times arc length.
    first: f64,
    /// Compliance times the inertia of the borne load.
    slowness: f64,
}

impl Sums {
    /// Whether the limb that a joint here would move is neither too fast nor too light.
    fn can_swing(&self) -> bool {
        let slow = self.slowness * FASTEST_RAD_S * FASTEST_RAD_S >= 1.0;
        self.compliance > 0.0 && slow && self.slowness >= LIGHTEST_KG_M2 * self.compliance
    }

    fn bend(self) -> Bend {
        Bend { arc: self.first / self.compliance, compliance: self.compliance }
    }
}

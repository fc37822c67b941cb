//! Which places of a plant become joints.

use crate::line::{Line, Lines, Step};

/// Joints of one axis, at most: so many that the midpoint rule is within half a per cent (1 / 4 n^2).
const MOST_ON_AXIS: u32 = 8;

/// Joints do not swing by themselves faster than this, radians a second: a stiffer limb would need a time step below half
/// a millisecond, and moves too little to be seen.
const FASTEST_RAD_S: f64 = 2000.0;

/// What a joint moves has at least this polar inertia, kg m2: that of a tenth of a gram at 3 mm. Less is nothing that a simulator
/// should spend a body on, and `MuJoCo` refuses 1e-15.
const LIGHTEST_KG_M2: f64 = 1e-9;

/// Where an axis bends, and how easily.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bend {
    /// Arc length, metres.
    pub(crate) arc: f64,
    /// Integral of ds / (E I) over the run of the axis that it stands for, radians per newton metre.
    pub(crate) compliance: f64,
}

/// The bends of each axis, `most` in all at most.
///
/// An axis with bending energy U under the reference load that has n joints lacks U / 4 n^2 of it (the error of the midpoint
/// rule for a rod with a weight at its end), and U without any. Joints are given one by one to the axis where the energy that
/// is lacking falls most; all other axes are rigid with what bears them. Within an axis each joint stands for a run with an
/// even share of the integral of (c F^2)^(1/3), where c is the compliance of a metre and F the geometric mean of the weights borne there
/// and at the foot: the division with the least error, for a hand that pulls at the tip, too. It stands at the run's centre of compliance, so that a run bends as far and as high up as
/// the beam does.
pub(crate) fn choose(lines: &Lines, most: u32) -> Vec<Vec<Bend>> {
    let mut counts = vec![0_u32; lines.all.len()];
    let energies: Vec<f64> =
        lines.all.iter().zip(&lines.steps).map(|(line, steps)| bending_energy(line, steps)).collect();
    let limits: Vec<u32> = lines.steps.iter().map(|steps| most_joints(steps)).collect();
    for _ in 0..most {
        let gains = (0..counts.len()).filter(|&row| counts[row] < limits[row]);
        let gains = gains.map(|row| (gain(energies[row], counts[row]), row)).filter(|(gain, _)| *gain > 0.0);
        // The first of equal ones.
        let best = gains.reduce(|a, b| if b.0 > a.0 { b } else { a });
        let Some((_, row)) = best else { break };
        counts[row] += 1;
    }
    lines.steps.iter().zip(counts).map(|(steps, count)| bends(steps, count)).collect()
}

/// The energy of an axis that may bend at all.
fn bending_energy(line: &Line, steps: &[Step]) -> f64 {
    if line.is_buried || line.is_rigid {
        return 0.0;
    }
    steps.iter().map(|s| s.energy).sum()
}

/// How much less energy is lacking with one joint more.
fn gain(energy: f64, joints: u32) -> f64 {
    let lacking = |n: u32| if n == 0 { energy } else { energy / (4.0 * f64::from(n * n)) };
    lacking(joints) - lacking(joints + 1)
}

/// Joints at which a limb is still slow enough. The highest frequency of a chain is about n^2 times its own (Dunkerley 1894);
/// what stands between two joints has the inertia of its wood alone, however much the tip bears.
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
        // A step that lies across a border is shared out.
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
    /// Compliance times the inertia of what is borne.
    slowness: f64,
}

impl Sums {
    /// Whether what a joint here would move is neither too quick nor too light.
    fn can_swing(&self) -> bool {
        let slow = self.slowness * FASTEST_RAD_S * FASTEST_RAD_S >= 1.0;
        self.compliance > 0.0 && slow && self.slowness >= LIGHTEST_KG_M2 * self.compliance
    }

    fn bend(self) -> Bend {
        Bend { arc: self.first / self.compliance, compliance: self.compliance }
    }
}

//! Finds the fruits that can break off, and the axes that are overloaded with fruits.

use std::collections::BTreeMap;

use base::Report;
use plant::{AxisKind, Plant};

use crate::line::{Lines, Step, is_fruit, place_of};

/// Most fruits that can break off: each moves freely and costs as much as three joints.
const MOST_BREAKABLE: usize = 24;

/// Least ratio of a stalk's strength to the weight of its fruit: with less, a fruit that sways in a breeze, which
/// doubles the pull, would tear off.
const LEAST_HOLD: f64 = 2.0;

/// Most mass of a fruit that hangs by a weld, as a multiple of the mass of the wood that it hangs on. The welds of
/// simulators are springs that are scaled by the masses at both ends: on a shaken limb in `MuJoCo`, such a fruit stays
/// within 0.7 mm of its place, one of 100 times the mass within 1.3 mm, and one of 3,000 times falls off.
const MOST_TIMES_BEARER: f64 = 50.0;

/// A fruit that sits on an axis above the ground with a thickness.
#[derive(Clone, Copy, Debug)]
struct Hanging {
    organ: usize,
    kilograms: f64,
    /// Pull at which its stalk breaks, newtons: strength times cross-section.
    break_force_n: f64,
}

/// The fruits of a plant.
#[derive(Clone, Debug)]
pub(crate) struct Fruits {
    /// Fruits on stalks that hold them with a margin, the heaviest first.
    held: Vec<Hanging>,
    /// Number of fruits on stalks without that margin.
    weak: usize,
    all: usize,
}

impl Fruits {
    /// Finds the fruits that their stalks hold, and makes a stalk that bears only such a fruit rigid: it weighs so
    /// little that nothing could hang on it.
    pub(crate) fn new(plant: &Plant, lines: &mut Lines, gravity: f64) -> Self {
        let mut own = Self { held: Vec::new(), weak: 0, all: 0 };
        let loads = loads(plant);
        for (organ, weight) in lines.organs.iter().enumerate() {
            if !is_fruit(plant.organs[organ].kind) {
                continue;
            }
            own.all += 1;
            let Some(node) = plant.organs[organ].bearer else { continue };
            let (axis, arc) = place_of(plant, &lines.all, node);
            let line = &mut lines.all[axis];
            let radius = line.point_and_radius_at(arc).1;
            if radius <= 0.0 || weight.mass <= 0.0 || weight.reach_m <= 0.0 {
                continue;
            }
            let break_force_n = line.tissue.strength_pa * base::ops::PI * radius * radius;
            if break_force_n < LEAST_HOLD * weight.mass * gravity {
                own.weak += 1;
                continue;
            }
            line.is_rigid |= line.bearer.is_some() && loads[axis] == 1;
            own.held.push(Hanging { organ, kilograms: weight.mass, break_force_n });
        }
        base::sort_by(&mut own.held, |a, b| b.kilograms.total_cmp(&a.kilograms).then(a.organ.cmp(&b.organ)));
        own
    }

    /// Returns the breaking force of each fruit that can break off, by its organ's row. `bearer_kg`: the mass of the
    /// wood that an organ hangs on.
    pub(crate) fn breakable(
        &self,
        bearer_kg: impl Fn(usize) -> f64,
        report: &mut Report,
    ) -> BTreeMap<usize, f64> {
        let (mut can, mut light): (Vec<&Hanging>, usize) = (Vec::new(), 0);
        for fruit in &self.held {
            if fruit.kilograms <= MOST_TIMES_BEARER * bearer_kg(fruit.organ) {
                can.push(fruit);
            } else {
                light += 1;
            }
        }
        self.tell((light, can.len()), report);
        can.truncate(MOST_BREAKABLE);
        can.into_iter().map(|fruit| (fruit.organ, fruit.break_force_n)).collect()
    }

    /// Warns which fruits are fixed, and why. `light`: those on wood that is too light for them; `can`: those that
    /// could break off.
    fn tell(&self, (light, can): (usize, usize), report: &mut Report) {
        let (all, weak) = (self.all, self.weak);
        if weak > 0 {
            base::warn!(
                report,
                "fruit-stalks-weak",
                { weak = weak, all = all, times = LEAST_HOLD },
                "{weak} of {all} fruits hang on stalks that do not hold {times} times their weight: they are fixed to what bears them and cannot break off; make stalks thicker or fruits smaller"
            );
        }
        if light > 0 {
            base::warn!(
                report,
                "fruits-outweigh",
                { light = light, all = all, times = MOST_TIMES_BEARER },
                "{light} of {all} fruits weigh more than {times} times the wood that bears them, where no weld holds: they are fixed to it and cannot break off; make stems thicker or fruits smaller"
            );
        }
        if can > MOST_BREAKABLE {
            base::warn!(
                report,
                "fruits-fixed",
                { all = can, kept = MOST_BREAKABLE },
                "of {all} fruits that hang on stalks the heaviest {kept} can break off; the others are part of what bears them"
            );
        }
    }
}

/// Returns how many organs and axes sit on each axis.
fn loads(plant: &Plant) -> Vec<usize> {
    let mut loads = vec![0; plant.axes.len()];
    let bearers =
        plant.organs.iter().map(|organ| organ.bearer).chain(plant.axes.iter().map(|axis| axis.bearer));
    for node in bearers.flatten() {
        loads[plant.nodes.axis[node.index()].index()] += 1;
    }
    loads
}

/// Warns of stems and branches that would break under their fruits at rest. Stalks are exempt: they bend until their
/// fruits hang below them.
pub(crate) fn tell_of_overload(lines: &Lines, report: &mut Report) {
    let stiff = lines.all.iter().zip(&lines.steps).filter(|(line, _)| line.kind != AxisKind::Petiole);
    let most = |steps: &[Step]| steps.iter().map(|step| step.fruit_stress).fold(0.0, f64::max);
    let broken: Vec<f64> = stiff.map(|(_, steps)| most(steps)).filter(|stress| *stress > 1.0).collect();
    if !broken.is_empty() {
        let times = broken.iter().copied().fold(0.0, f64::max);
        base::warn!(
            report,
            "fruits-overload",
            { axes = broken.len(), times = format!("{times:.1}") },
            "{axes} of its axes would break under their fruits, which bend them with up to {times} times the stress that they bear: make these axes thicker or the fruits smaller"
        );
    }
}

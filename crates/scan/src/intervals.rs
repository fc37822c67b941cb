//! Intervals of the figures of a found tree.

use base::ops;
use plant::{AxisId, Plant};

use crate::radii::PipeSource;
use crate::wanted::ScanTally;

/// An interval that holds 9 of 10 true values, as measured on virtual trees (`docs/scans.md`).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Interval {
    /// Least plausible value.
    pub low: f64,
    /// Greatest plausible value.
    pub high: f64,
}

/// Intervals of a found tree.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Intervals {
    /// Height, metres.
    pub height_m: Interval,
    /// Diameter at 1.3 m, metres; none for a lower tree.
    pub dbh_m: Option<Interval>,
    /// Volume of the wood, cubic metres.
    pub volume_m3: Interval,
}

/// Accuracy of the radius of a node.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SeenNode {
    /// Standard error of its logarithm.
    pub(crate) error: f64,
    /// A circle was found there.
    pub(crate) is_seen: bool,
}

/// Nine tenths of a normal distribution lie within this number of standard deviations.
const NINE_TENTHS: f64 = 1.645;

/// Errors beyond those of the fits, as standard deviations; chosen on virtual trees (`docs/scans.md`).
struct Unknowns {
    /// Error of the logarithm of the volume of wood whose radius was not seen, with a fitted exponent.
    model: f64,
    /// The same with an exponent that was not fitted.
    guess: f64,
    /// Error of the logarithm of all volume: sections are not circles, and twigs are missing.
    form: f64,
    /// The same for a tree in leaf.
    form_in_leaf: f64,
    /// Error of the logarithm of a diameter.
    bark: f64,
    /// Error of the height, as a share of it; the edge of a cube is added.
    top: f64,
    /// The same for a tree in leaf.
    top_in_leaf: f64,
}

const UNKNOWNS: Unknowns = Unknowns {
    model: 0.3,
    guess: 0.8,
    form: 0.08,
    form_in_leaf: 0.15,
    bark: 0.01,
    top: 0.002,
    top_in_leaf: 0.01,
};

impl Intervals {
    /// Computes the intervals from the errors of the smoothed radii (those of one axis go together, those of
    /// different axes are independent) and from the unknowns.
    pub(crate) fn new(plant: &Plant, nodes: &[SeenNode], tally: &ScanTally, in_leaf: bool) -> Self {
        let measured = plant.measure();
        let u = &UNKNOWNS;
        let (mut square, mut unseen, mut whole) = (0.0, 0.0, 0.0);
        for id in (0..plant.axes.len()).map(AxisId::new) {
            let (line, radii) = (plant.axis_points(id), plant.axis_radii(id));
            let start = plant.axis(id).nodes.start as usize;
            let mut off = 0.0;
            for i in 1..line.len() {
                let (r, s) = (radii[i - 1], radii[i]);
                let volume = ops::PI / 3.0 * line[i].distance(line[i - 1]) * (r * r + r * s + s * s);
                let node = nodes[start + i];
                whole += volume;
                if node.is_seen {
                    off += 2.0 * volume * node.error;
                } else {
                    unseen += volume;
                }
            }
            square += off * off;
        }
        let model = if tally.pipe_source == PipeSource::Fitted { u.model } else { u.guess };
        let form = if in_leaf { u.form_in_leaf } else { u.form };
        let log_volume = if whole > 0.0 {
            let unseen = unseen / whole * model;
            (square / (whole * whole) + unseen * unseen + form * form).sqrt()
        } else {
            0.0
        };
        let top = if in_leaf { u.top_in_leaf } else { u.top };
        let off = NINE_TENTHS * (top * measured.height_m + tally.cell_m);
        let height_m = Interval { low: (measured.height_m - off).max(0.0), high: measured.height_m + off };
        let dbh_m = measured.dbh_m.map(|d| {
            let error = at_breast_height(plant, nodes);
            Interval::around(d, (error * error + u.bark * u.bark).sqrt())
        });
        Self { height_m, dbh_m, volume_m3: Interval::around(measured.wood_volume_m3, log_volume) }
    }
}

impl Interval {
    /// Returns the interval about a figure whose logarithm has this standard error.
    fn around(figure: f64, error: f64) -> Self {
        let factor = ops::exp(NINE_TENTHS * error);
        Self { low: figure / factor, high: figure * factor }
    }
}

/// Returns the error of the thickest stem at 1.3 m.
fn at_breast_height(plant: &Plant, nodes: &[SeenNode]) -> f64 {
    let stems = (0..plant.axes.len()).map(AxisId::new).filter(|&id| plant.axis(id).bearer.is_none());
    let thickest = stems.max_by(|&a, &b| {
        let foot = |id: AxisId| plant.axis_radii(id).first().copied().unwrap_or(0.0);
        foot(a).total_cmp(&foot(b))
    });
    let Some(id) = thickest else { return 0.0 };
    let start = plant.axis(id).nodes.start as usize;
    let off = |i: &usize| (plant.axis_points(id)[*i].y - 1.3).abs();
    let nearest = (0..plant.axis_points(id).len()).min_by(|a, b| off(a).total_cmp(&off(b)));
    nearest.map_or(0.0, |i| nodes[start + i].error)
}

//! Length, area, volume and angles, order by order; stems at breast height.

use base::ops;
use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::BREAST_M;
use crate::{Axis, NodeId, Plant};

/// Measures of one branching order.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct OrderMeasures {
    /// Order: 0 for the main axes, 1 for the axes that they bear, and so on.
    pub order: u32,
    /// Number of axes.
    pub axes: usize,
    /// Length of the axes, metres.
    pub length_m: f64,
    /// Volume of the frusta, cubic metres.
    pub volume_m3: f64,
    /// Lateral area of the frusta, square metres.
    pub area_m2: f64,
    /// Mean angle between an axis's first internode and the internode that bears it, degrees, 0 to 180; `None` for
    /// order 0.
    pub angle_mean_deg: Option<f64>,
    /// Standard deviation of these angles (n - 1), degrees; `None` for fewer than two.
    pub angle_sd_deg: Option<f64>,
}

pub(super) fn orders(plant: &Plant, shoot: &[bool]) -> Vec<OrderMeasures> {
    let last = plant.axes.iter().zip(shoot).filter(|(_, s)| **s).map(|(a, _)| a.order as usize + 1).max();
    let mut orders: Vec<OrderMeasures> = (0_u32..)
        .take(last.unwrap_or(0))
        .map(|order| OrderMeasures { order, ..Default::default() })
        .collect();
    let mut angles: Vec<Vec<f64>> = vec![Vec::new(); orders.len()];
    for (axis, _) in plant.axes.iter().zip(shoot).filter(|(_, s)| **s) {
        let at = axis.order as usize;
        let order = &mut orders[at];
        order.axes += 1;
        for (i, j) in internodes(axis) {
            let (h, r, s) = (
                plant.nodes.position[i].distance(plant.nodes.position[j]),
                plant.nodes.radius_m[i],
                plant.nodes.radius_m[j],
            );
            order.length_m += h;
            order.volume_m3 += ops::PI / 3.0 * h * (r * r + r * s + s * s);
            order.area_m2 += ops::PI * (r + s) * ((r - s) * (r - s) + h * h).sqrt();
        }
        angles[at].extend(angle(plant, axis));
    }
    for (order, angles) in orders.iter_mut().zip(&angles) {
        let n = angles.len() as f64;
        let mean = angles.iter().sum::<f64>() / n;
        order.angle_mean_deg = (!angles.is_empty()).then_some(mean);
        let squares = angles.iter().map(|a| (a - mean) * (a - mean)).sum::<f64>();
        order.angle_sd_deg = (angles.len() > 1).then(|| (squares / (n - 1.0)).sqrt());
    }
    orders
}

/// Iterates over the rows of the two nodes of each internode, base first.
pub(super) fn internodes(axis: &Axis) -> impl Iterator<Item = (usize, usize)> + use<> {
    let (start, end) = (axis.nodes.start as usize, axis.nodes.end as usize);
    (start + 1..end).map(|j| (j - 1, j))
}

/// Returns the internode that bears an axis or organ on a node: the one that ends there, or the first of its axis.
pub(super) fn bearing_internode(plant: &Plant, bearer: NodeId) -> (usize, usize) {
    let (axis, at) = (plant.axis(plant.nodes.axis[bearer.index()]), bearer.index());
    if at > axis.nodes.start as usize { (at - 1, at) } else { (at, at + 1) }
}

/// Returns the angle between an axis's first internode with a length and the one that bears it, degrees.
pub(super) fn angle(plant: &Plant, axis: &Axis) -> Option<f64> {
    let direction =
        |(i, j): (usize, usize)| (plant.nodes.position[j] - plant.nodes.position[i]).try_normalize();
    let below = direction(bearing_internode(plant, axis.bearer?))?;
    let own = internodes(axis).find_map(direction)?;
    Some(angle_deg(below, own))
}

/// Returns the angle between unit vectors; exact at 0, 90 and 180 degrees, where an arc cosine alone loses digits.
fn angle_deg(a: DVec3, b: DVec3) -> f64 {
    ops::atan2(a.cross(b).length(), a.dot(b)).to_degrees()
}

/// Axes that stand on the ground, and their diameter at breast height.
pub(super) struct Stems {
    pub(super) count: usize,
    pub(super) dbh_m: Option<f64>,
}

pub(super) fn stems(plant: &Plant, shoot: &[bool]) -> Stems {
    let standing = || plant.axes.iter().zip(shoot).filter(|(a, s)| **s && a.bearer.is_none()).map(|(a, _)| a);
    let squares: Vec<f64> = standing().filter_map(|a| diameter(plant, a)).map(|d| d * d).collect();
    let dbh_m = (!squares.is_empty()).then(|| squares.iter().sum::<f64>().sqrt());
    Stems { count: standing().count(), dbh_m }
}

/// Returns twice the radius where the axis first passes breast height above its foot.
fn diameter(plant: &Plant, axis: &Axis) -> Option<f64> {
    let level = plant.nodes.position[axis.nodes.start as usize].y + BREAST_M;
    let (y, r) = (|i: usize| plant.nodes.position[i].y, |i: usize| plant.nodes.radius_m[i]);
    let (i, j) = internodes(axis).find(|&(i, j)| y(i) < level && y(j) >= level)?;
    let t = (level - y(i)) / (y(j) - y(i));
    Some(2.0 * (r(i) + (r(j) - r(i)) * t))
}

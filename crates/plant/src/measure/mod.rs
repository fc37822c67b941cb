//! Measures that a botanist would check.
//!
//! `Plant -> Measures`: size, crown, leaf area, branching, wood

mod branching;
mod crown;
mod wood;

use serde::{Deserialize, Serialize};

use crate::Plant;

pub use branching::{RadiusExponent, Strahler};
pub use wood::OrderMeasures;

/// Measures of any plant: metres, square and cubic metres, degrees.
///
/// The *shoot* is every trunk, branch, twig and stem: roots and leaf stalks do not count. Heights are above the lowest
/// foot of an axis without a bearer, or above y = 0 if there is none: a plant in the coordinates of a scanner is as
/// high as at the origin. `docs/measures.md` gives each definition with its source.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Measures {
    /// Height of the highest point of shoot or organ above the foot, metres; 0 for a plant without either.
    pub height_m: f64,
    /// Number of axes that stand on the ground.
    pub stems: usize,
    /// Diameter at breast height (1.3 m above the foot), metres, without bark flare or taper models; of several stems
    /// the quadratic sum, which preserves their basal area. `None` if no stem is that tall.
    pub dbh_m: Option<f64>,
    /// Height at which the main axis bears its lowest live branch or leaf, metres. A branch is live if it bears leaves
    /// (on a plant without leaves: always). `None` for a plant without either.
    pub crown_base_m: Option<f64>,
    /// Volume of the convex hull of all live branches, of the main axes above the crown base, and of all leaves, cubic
    /// metres; 0 for a flat crown.
    pub crown_volume_m3: f64,
    /// Area of the convex hull of the crown seen from above, square metres.
    pub crown_projection_m2: f64,
    /// Number of leaves.
    pub leaves: usize,
    /// Area of one side of all leaves, square metres; round leaves count half their surface (Chen and Black 1992),
    /// shoots in needles or scales the area that these cover ([`Shape::one_side_m2`](crate::Shape::one_side_m2)).
    pub leaf_area_m2: f64,
    /// Leaf area index: leaf area over crown projection area (Watson 1947); `None` without a projection.
    pub lai: Option<f64>,
    /// Volume of the shoot's frusta, cubic metres; overlaps at a fork count twice.
    pub wood_volume_m3: f64,
    /// Lateral area of the shoot's frusta, square metres.
    pub wood_area_m2: f64,
    /// Length of all axes of the shoot, metres.
    pub length_m: f64,
    /// By branching order (Gravelius 1914; centrifugal): the trunk is order 0.
    pub orders: Vec<OrderMeasures>,
    /// Strahler's centripetal orders.
    pub strahler: Strahler,
    /// The exponent of `r^n = r_1^n + ... + r_m^n` that fits the forks best; `None` without a fork.
    pub radius_exponent: Option<RadiusExponent>,
}

/// Breast height, metres (1.3 m: IUFRO; the United States measure at 1.37 m).
const BREAST_M: f64 = 1.3;

impl Plant {
    /// Measures a sound plant.
    ///
    /// Guaranteed: finite numbers, the same bits everywhere. Cost: linear in nodes and leaves, n log n for the hulls.
    ///
    /// ```
    /// use glam::DVec3;
    /// let mut p = plant::Plant::default();
    /// p.add_axis(plant::AxisKind::Branch, None, 1, &[DVec3::ZERO, DVec3::Y * 2.6], None);
    /// p.nodes.radius_m = vec![0.2, 0.0];
    /// let m = p.measure();
    /// assert_eq!((m.height_m, m.dbh_m, m.stems), (2.6, Some(0.2), 1));
    /// ```
    pub fn measure(&self) -> Measures {
        let shoot = self.shoot();
        let (orders, stems) = (wood::orders(self, &shoot), wood::stems(self, &shoot));
        let leaf_area = crown::leaf_area(self);
        let crown = crown::crown(self, &shoot);
        let sum = |f: fn(&OrderMeasures) -> f64| orders.iter().map(f).sum::<f64>();
        Measures {
            height_m: crown.height_m,
            stems: stems.count,
            dbh_m: stems.dbh_m,
            crown_base_m: crown.base_m,
            crown_volume_m3: crown.volume_m3,
            crown_projection_m2: crown.projection_m2,
            leaves: self.organs.iter().filter(|o| o.kind == crate::OrganKind::Leaf).count(),
            leaf_area_m2: leaf_area,
            lai: (crown.projection_m2 > 0.0).then(|| leaf_area / crown.projection_m2),
            wood_volume_m3: sum(|o| o.volume_m3),
            wood_area_m2: sum(|o| o.area_m2),
            length_m: sum(|o| o.length_m),
            strahler: branching::strahler(self, &shoot),
            radius_exponent: branching::radius_exponent(self, &shoot),
            orders,
        }
    }

    /// Returns the area of one side of each organ, as it is bent, square metres ([`Shape::one_side_m2`](crate::Shape)); 0
    /// for an organ without a shape. Cost: that of each shape once.
    pub fn organ_areas_m2(&self) -> Vec<f64> {
        let mut used = vec![false; self.shapes.len()];
        for organ in &self.organs {
            if let Some(used) = used.get_mut(organ.shape.index()) {
                *used = true;
            }
        }
        let areas: Vec<f64> = self
            .shapes
            .iter()
            .zip(&used)
            .map(|(s, used)| if *used { s.one_side_m2() } else { 0.0 })
            .collect();
        let area = |o: &crate::Organ| areas.get(o.shape.index()).copied().unwrap_or(0.0) * o.scale * o.scale;
        self.organs.iter().map(area).collect()
    }

    /// Returns the length of each axis, from node to node, metres.
    pub fn axis_lengths_m(&self) -> Vec<f64> {
        let length = |(i, j): (usize, usize)| self.nodes.position[i].distance(self.nodes.position[j]);
        self.axes.iter().map(|axis| wood::internodes(axis).map(length).sum()).collect()
    }

    /// Returns the angle between the first internode of each axis and the internode that bears it, degrees, 0 to 180; NaN
    /// for axes that stand on the ground.
    pub fn axis_angles_deg(&self) -> Vec<f64> {
        self.axes.iter().map(|axis| wood::angle(self, axis).unwrap_or(f64::NAN)).collect()
    }

    /// Returns for each axis whether it belongs to the shoot of a sound plant: no roots, no leaf stalks, no stubs, and
    /// nothing that these bear.
    pub fn shoot(&self) -> Vec<bool> {
        let mut shoot = vec![false; self.axes.len()];
        for (i, axis) in self.axes.iter().enumerate() {
            let own = axis.kind.is_shoot();
            shoot[i] = own && axis.bearer.is_none_or(|b| shoot[self.nodes.axis[b.index()].index()]);
        }
        shoot
    }
}

#[cfg(test)]
mod tests;

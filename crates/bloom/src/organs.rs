//! Converts the organs of a flower on one day to parts of a plant: sheets and strands at the position of the flower.

use std::sync::Arc;

use base::Seed;
use glam::{DQuat, DVec3};
use plant::{FlowerId, Frame, NodeId, Organ, OrganKind, Paint, Plant, Shape, Sheet, Venation};

/// Position of a flower: its own origin and its axis +y are moved there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seat {
    /// Foot of its stalk, or of the flower if it has none; metres.
    pub centre: DVec3,
    /// Rotation from the flower's own axes to the plant's.
    pub turn: DQuat,
    /// The node that bears it.
    pub bearer: Option<NodeId>,
}

impl Default for Seat {
    /// Returns an upright seat on the ground.
    fn default() -> Self {
        Self { centre: DVec3::ZERO, turn: DQuat::IDENTITY, bearer: None }
    }
}

impl Seat {
    pub(crate) fn transform(&self, p: DVec3) -> DVec3 {
        self.centre + self.turn * p
    }
}

/// One flower under construction.
pub(crate) struct Bed<'a> {
    pub plant: &'a mut Plant,
    pub flower: FlowerId,
    pub bearer: Option<NodeId>,
    /// Its position and rotation in the plant.
    pub place: (DVec3, DQuat),
    /// Its size as a share: buds of a cluster that are younger than the first day are smaller.
    pub size: f64,
    /// Seed of the keys of its organs.
    pub seed: Seed,
}

/// A grid of points in the flower's own coordinates.
pub(crate) struct Grid {
    pub points: Vec<DVec3>,
    pub across: Vec<f64>,
    pub along: Vec<f64>,
    pub colors: Vec<[f32; 3]>,
}

impl Bed<'_> {
    pub(crate) fn transform(&self, p: DVec3) -> DVec3 {
        self.place.0 + self.place.1 * (p * self.size)
    }

    fn push(&mut self, kind: OrganKind, shape: Shape, frame: Frame, rgb: [f32; 3]) {
        let shape = self.plant.add_shape(shape);
        // Organs of a flower come in the same order on every day.
        let key = self.seed.child(self.plant.organs.len() as u64).number();
        let (bearer, flower, paint) = (self.bearer, Some(self.flower), Paint::Tinted(rgb));
        let organ = Organ { kind, bearer, flower, shape, frame, scale: 1.0, paint, key, source: None };
        self.plant.organs.push(organ);
    }

    /// Adds a petal: root in the first row, tip in the last.
    pub(crate) fn petal(&mut self, kind: OrganKind, grid: Grid) {
        let points = grid.points.iter().map(|&p| self.transform(p)).collect();
        self.loose_petal(kind, Grid { points, ..grid });
    }

    /// Adds a petal whose points are in the plant's coordinates.
    pub(crate) fn loose_petal(&mut self, kind: OrganKind, grid: Grid) {
        let Grid { points, across, along, colors } = grid;
        let sheet = Sheet { points, across, along, colors, veins: Venation::default(), form: None };
        if let Some((sheet, frame)) = sheet.framed() {
            self.push(kind, Shape::Sheet(Arc::new(sheet)), frame, [1.0; 3]);
        }
    }

    /// Adds an organ around the flower's axis, in a frame that looks along it from `foot`.
    pub(crate) fn around(&mut self, kind: OrganKind, foot: DVec3, grid: Grid) {
        let points = grid.points.iter().map(|&p| (p - foot) * self.size);
        // Local z is the flower's y.
        let points = points.map(|p| DVec3::new(p.z, p.x, p.y)).collect();
        let Grid { across, along, colors, .. } = grid;
        let sheet = Sheet { points, across, along, colors, veins: Venation::default(), form: None };
        let [right, up, normal] = [DVec3::Z, DVec3::X, DVec3::Y].map(|d| self.place.1 * d);
        let frame = Frame { origin: self.transform(foot), right, along: up, normal };
        self.push(kind, Shape::Sheet(Arc::new(sheet)), frame, [1.0; 3]);
    }

    /// Adds a strand through points of the flower's own coordinates, root first.
    pub(crate) fn strand(&mut self, kind: OrganKind, line: &[DVec3], radii: &[f64], rgb: [f32; 3]) {
        let line: Vec<DVec3> = line.iter().map(|&p| self.transform(p)).collect();
        let radii = radii.iter().map(|r| r * self.size).collect();
        self.loose_strand(kind, &line, radii, rgb);
    }

    /// Adds a stalk of one thickness through points of the plant.
    pub(crate) fn stalk(&mut self, line: &[DVec3], radius: f64) {
        self.loose_strand(OrganKind::Pedicel, line, vec![radius; line.len()], [1.0; 3]);
    }

    fn loose_strand(&mut self, kind: OrganKind, line: &[DVec3], radius_m: Vec<f64>, rgb: [f32; 3]) {
        let (Some(&root), Some(&end)) = (line.first(), line.last()) else { return };
        let frame = Frame::looking(root, end - root, DVec3::Z);
        let path = line.iter().map(|&p| frame.localise(p)).collect();
        self.push(kind, Shape::Strand { path, radius_m, knob_m: 0.0 }, frame, rgb);
    }
}

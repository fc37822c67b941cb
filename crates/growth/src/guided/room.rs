//! Room of buds: an envelope, and the tubes of brush strokes.

use base::{Budget, Counted, ops};
use geom::KdTree;
use glam::DVec3;

use super::spec::{BrushStroke, GuidedSpec};
use crate::envelope::Region;
use crate::{GrowthError, Obstacles};

/// One point of a stroke.
#[derive(Clone, Copy, Debug)]
struct Piece {
    from: DVec3,
    to: DVec3,
    radius: (f64, f64),
    tangent: DVec3,
    pull: f64,
}

/// Strokes cut into pieces no longer than their radius, found by a grid.
#[derive(Clone, Debug)]
struct Tubes {
    pieces: Vec<Piece>,
    grid: KdTree,
    reach: f64,
}

/// The room of a run.
#[derive(Clone, Debug)]
pub(super) struct Room {
    region: Option<(Region, Vec<DVec3>)>,
    tubes: Option<Tubes>,
    obstacles: Obstacles,
}

/// Guidance of a marker by a stroke.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Guide {
    /// `w' = exp(-d'^2 / (2 sigma_b^2))`, `sigma_b` half the radius.
    pub(super) weight: f64,
    /// The stroke's direction there, times its pull `k_s`.
    pub(super) along: DVec3,
}

impl Tubes {
    fn new(strokes: &[BrushStroke], budget: &Budget) -> Result<Option<Self>, GrowthError> {
        let mut pieces = Vec::new();
        for stroke in strokes {
            let radius =
                |i: usize| stroke.radius_m.get(i).or(stroke.radius_m.first()).copied().unwrap_or(1.0);
            for (i, w) in stroke.points.windows(2).enumerate() {
                let (r, s) = (radius(i), radius(i + 1));
                let Some(tangent) = (w[1] - w[0]).try_normalize() else { continue };
                let wish = (w[0].distance(w[1]) / r.min(s)).ceil().clamp(1.0, 1000.0);
                let all = pieces.len() as f64 + wish;
                budget.check_estimate(
                    Counted::Points,
                    all,
                    "make strokes.radius_m larger or strokes shorter",
                )?;
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to 1000")]
                let n = wish as u32;
                let at = |k: u32| f64::from(k) / f64::from(n);
                pieces.extend((0..n).map(|k| Piece {
                    from: w[0].lerp(w[1], at(k)),
                    to: w[0].lerp(w[1], at(k + 1)),
                    radius: (ops::lerp(r, s, at(k)), ops::lerp(r, s, at(k + 1))),
                    tangent,
                    pull: stroke.pull,
                }));
            }
        }
        // Everything in a piece's tube is within its radius and half of its length of its centre.
        let reach = pieces
            .iter()
            .map(|p| p.radius.0.max(p.radius.1) + 0.5 * p.from.distance(p.to))
            .fold(0.0, f64::max);
        let middles: Vec<DVec3> = pieces.iter().map(|p| p.from.lerp(p.to, 0.5)).collect();
        Ok((!pieces.is_empty()).then(|| Self { grid: KdTree::new(&middles), pieces, reach }))
    }

    /// Returns the strongest guide at a point; `None` outside every tube.
    fn guide(&self, p: DVec3, near: &mut Vec<usize>) -> Option<Guide> {
        self.grid.within(p, self.reach, near);
        let mut best: Option<Guide> = None;
        for piece in near.iter().map(|&i| &self.pieces[i]) {
            let d = piece.to - piece.from;
            let t = ((p - piece.from).dot(d) / d.length_squared().max(1e-300)).clamp(0.0, 1.0);
            let (away, radius) =
                (p.distance(piece.from + d * t), ops::lerp(piece.radius.0, piece.radius.1, t));
            let sigma = 0.5 * radius;
            let weight = ops::exp(-away * away / (2.0 * sigma * sigma));
            if away <= radius && best.is_none_or(|b| weight > b.weight) {
                best = Some(Guide { weight, along: piece.tangent * piece.pull });
            }
        }
        best
    }
}

impl Room {
    pub(super) fn new(
        spec: &GuidedSpec,
        roots: Vec<DVec3>,
        obstacles: &Obstacles,
        budget: &Budget,
    ) -> Result<Self, GrowthError> {
        let region = spec.envelope.as_ref().map(|e| e.prepare()).transpose()?.map(|r| (r, roots));
        Ok(Self { region, tubes: Tubes::new(&spec.strokes, budget)?, obstacles: obstacles.clone() })
    }

    /// Replaces the guiding strokes.
    pub(super) fn set_strokes(
        &mut self,
        strokes: &[BrushStroke],
        budget: &Budget,
    ) -> Result<(), GrowthError> {
        self.tubes = Tubes::new(strokes, budget)?;
        Ok(())
    }

    /// Whether the envelope alone decides the places of markers.
    pub(super) fn is_plain(&self) -> bool {
        self.tubes.is_none() && self.obstacles.is_empty()
    }

    /// Whether a point is in the envelope of a root.
    #[inline]
    pub(super) fn surrounds(&self, p: DVec3) -> bool {
        match &self.region {
            Some((region, roots)) => roots.iter().any(|r| region.contains(p - *r)),
            None => true,
        }
    }

    /// Returns the guide of a marker at a point; `None` if no marker may be there. Without strokes, weight 1 and no
    /// direction.
    pub(super) fn guide_at(&self, p: DVec3, near: &mut Vec<usize>) -> Option<Guide> {
        if !self.surrounds(p) {
            return None;
        }
        if !self.obstacles.is_empty() && !self.obstacles.free(p) {
            return None;
        }
        match &self.tubes {
            Some(tubes) => tubes.guide(p, near),
            None => Some(Guide { weight: 1.0, along: DVec3::ZERO }),
        }
    }

    /// Whether a marker may be anywhere in a ball, without guidance; false if that is uncertain.
    pub(super) fn is_open(&self, p: DVec3, radius: f64) -> bool {
        self.tubes.is_none()
            && self.obstacles.is_empty()
            && self
                .region
                .as_ref()
                .is_none_or(|(region, roots)| roots.iter().any(|r| region.contains_ball(p - *r, radius)))
    }

    /// Returns the obstacles of growth.
    pub(super) const fn obstacles(&self) -> &Obstacles {
        &self.obstacles
    }

    /// Whether there are guiding strokes.
    pub(super) const fn is_guided(&self) -> bool {
        self.tubes.is_some()
    }

    /// Returns the height above a root at which the envelope starts; 0 without one.
    pub(super) fn foot(&self) -> f64 {
        self.region.as_ref().map_or(0.0, |(region, _)| region.foot())
    }
}

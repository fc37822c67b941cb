//! Organs that were traced over a photograph take its pixels: their texture coordinates are their positions in the
//! front view, in which they were drawn.

use std::sync::Arc;

use glam::DVec3;
use mesh::{Texture, TriMesh};

use crate::sleeve::{narrow2, wide};
use crate::spine::Spine;

// Factor on the distance from an organ's centre at which it takes its pixels: users trace slightly outside an edge.
const INSET: f64 = 0.95;
// Share of the width of its stroke that a tube shows: the pixels next to a thin stem are background.
const ACROSS: f64 = 0.5;

/// A photograph in the plant's plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Traced {
    /// Its pixels.
    pub texture: Arc<Texture>,
    /// Strokes that were traced over it, by index in the drawing.
    pub strokes: base::Set<u32>,
    /// Left and upper edge of the picture, metres in the plant's plane z = 0.
    pub corner_m: (f64, f64),
    /// Its width and height, metres, above 0.
    pub size_m: (f64, f64),
}

impl Traced {
    /// Whether an organ read from a stroke was traced.
    pub(crate) fn has(&self, source: Option<u32>) -> bool {
        source.is_some_and(|s| self.strokes.contains_key(&s))
    }

    fn uv(&self, p: DVec3) -> [f32; 2] {
        let (u, v) = ((p.x - self.corner_m.0) / self.size_m.0, (self.corner_m.1 - p.y) / self.size_m.1);
        narrow2(u.clamp(0.0, 1.0), v.clamp(0.0, 1.0))
    }

    /// Sets texture coordinates of the vertices from `first` on: one organ.
    pub(crate) fn organ(&self, mesh: &mut TriMesh, first: usize) {
        let places = mesh.positions.get(first..).unwrap_or_default();
        #[expect(clippy::cast_precision_loss, reason = "counts far below 2^52")]
        let middle = places.iter().copied().map(wide).sum::<DVec3>() / places.len().max(1) as f64;
        mesh.uvs.truncate(first);
        mesh.uvs.extend(places.iter().map(|&p| self.uv(middle + (wide(p) - middle) * INSET)));
    }

    /// Sets texture coordinates of a tube around `spine`.
    pub(crate) fn tube(&self, mesh: &mut TriMesh, spine: &Spine) {
        let mut hint = 0;
        mesh.uvs.clear();
        for p in &mesh.positions {
            let p = DVec3::new(f64::from(p[0]), f64::from(p[1]), f64::from(p[2]));
            let (station, near) = spine.nearest(p, hint);
            hint = near;
            mesh.uvs.push(self.uv(station.centre + (p - station.centre) * ACROSS));
        }
    }
}

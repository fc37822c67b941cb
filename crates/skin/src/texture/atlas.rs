//! The leaf of a plant and some of its shoots in one picture, cut out by alpha.

use std::sync::Arc;

use base::{Cancelled, Digest, Run, map_until_cancelled, ops};
use glam::DVec2;
use mesh::{Maps, Texture};
use plant::{Blade, SeenNeedle};

use super::blades::LeafInks;
use super::foliage::{LEAF_DEPTH, Plan};
use super::relief::{Sheet, Spot, Surface, surface};
use super::{Paint, byte, mix, shade};
use crate::BladeChart;
use crate::natural::VeinPattern;
use crate::needles::Cut;
use crate::shoots::{Shoots, Tile, chart_place, columns};

/// Contents of an atlas.
pub(crate) struct Leafage<'a> {
    pub(crate) venation: VeinPattern,
    pub(crate) leaf: &'a Blade,
    pub(crate) shoots: Option<&'a Shoots>,
    pub(crate) inks: &'a LeafInks,
    /// sRGB colour of the wood of shoots.
    pub(crate) wood: Paint,
}

/// Paints the atlas with cells of `size` pixels a side: the leaf, then the shoots. In empty places alpha is 0 and the
/// colour that of leaves, so that coarser copies have no seams.
pub(crate) fn atlas(what: &Leafage<'_>, size: u32, run: &Run<'_>) -> Result<Surface, Cancelled> {
    let mut content = Digest::new();
    content.add("atlas").add(&(what.venation as u32)).add(&size);
    content.add(&what.leaf.outline).add(&what.leaf.midrib).add(&what.leaf.veins);
    content.add(&what.inks.dark).add(&what.inks.light).add(&what.inks.vein).add(&what.wood);
    if let Some(needles) = what.leaf.needles {
        for x in [needles.length, needles.width, needles.spacing, needles.angle] {
            content.add(&x);
        }
    }
    if let Some(shoots) = what.shoots {
        shoots.digest(&mut content);
    }
    Surface::kept(content, || {
        let plan = Plan::new(what.venation, what.leaf, run.executor);
        let cut = Cut::new(what.leaf);
        let tiles = what.shoots.map_or(&[][..], |s| &s.tiles);
        let cells: Vec<Surface> = core::iter::once(None)
            .chain(tiles.iter().map(Some))
            .map(|tile| Cell::new(what, (&plan, &cut), tile).painted(size, run))
            .collect::<Result<_, Cancelled>>()?;
        Ok(joined(&cells, size))
    })
}

/// Alpha between needles, below the one half at which holes are cut: where needles cover 43 % and more, coarser copies
/// are closed.
const GAP: f64 = 0.12;

/// Contents of one place of a cell.
struct Seen {
    spot: Spot,
    tilt: DVec2,
    covered: bool,
}

/// One cell of the atlas: a leaf alone, or a shoot.
struct Cell<'a> {
    what: &'a Leafage<'a>,
    plan: &'a Plan,
    cut: &'a Cut,
    tile: Option<&'a Tile>,
    chart: BladeChart,
    extent: DVec2,
    /// The largest leaf.
    scale: f64,
}

impl<'a> Cell<'a> {
    fn new(what: &'a Leafage<'a>, (plan, cut): (&'a Plan, &'a Cut), tile: Option<&'a Tile>) -> Self {
        let chart = BladeChart::new(tile.map_or(what.leaf, |t| &t.card));
        let extent = (chart.place(DVec2::new(1.0, 0.5)) - chart.place(DVec2::new(0.0, 0.5))).x;
        let high = chart.place(DVec2::new(0.5, 0.0)).y - chart.place(DVec2::new(0.5, 1.0)).y;
        let scale = tile.map_or(1.0, |t| t.leaves.iter().map(|l| l.scale).fold(0.0, f64::max));
        Self { what, plan, cut, tile, chart, extent: DVec2::new(extent.max(1e-9), high.max(1e-9)), scale }
    }

    fn seen_at(&self, u: f64, v: f64) -> Seen {
        let uv = chart_place(DVec2::new(u, v));
        let inside = uv.x > 0.0 && uv.x < 1.0 && uv.y > 0.0 && uv.y < 1.0;
        let p = self.chart.place(uv);
        let inks = self.what.inks;
        let none = || Seen {
            spot: Spot { height: 0.0, paint: mix(inks.dark, inks.light, 0.5), rough: 0.9, through: 0.6 },
            tilt: DVec2::ZERO,
            covered: false,
        };
        let Some(tile) = self.tile else {
            let clamped = uv.clamp(DVec2::ZERO, DVec2::ONE);
            let spot = self.leaf_spot(p, clamped);
            return Seen { spot, tilt: DVec2::ZERO, covered: inside && self.cut.has(p) };
        };
        if !inside {
            return none();
        }
        if let Some((flat, own)) = tile.seen(self.cut, p) {
            let uv = self.plan.chart.uv(own);
            let mut spot = self.leaf_spot(own, uv);
            spot.height *= flat.scale / self.scale;
            spot.paint = shade(spot.paint, flat.lit);
            return Seen { spot, tilt: flat.tilt, covered: true };
        }
        let mut seen = none();
        if tile.on_wood(p) {
            seen.spot = Spot { height: 0.5, paint: self.what.wood, rough: 0.95, through: 0.0 };
            seen.covered = true;
        }
        seen
    }

    /// Returns the leaf at a point of its plane, and of its chart.
    fn leaf_spot(&self, p: DVec2, uv: DVec2) -> Spot {
        let inks = self.what.inks;
        let Some(needles) = &self.cut.needles else { return self.plan.spot(inks, uv.x, uv.y) };
        match needles.seen_at(p) {
            Some(SeenNeedle::Wood) => Spot { height: 0.35, paint: self.what.wood, rough: 0.95, through: 0.0 },
            Some(SeenNeedle::Needle { across, along, shade: own }) => {
                // Round, with a pale line on each side of the keel; light towards its tip, which is in the sun.
                let round = (1.0 - across * across).max(0.0).sqrt();
                let paint = mix(inks.dark, inks.light, 0.15 + 0.45 * own + 0.35 * along);
                let paint = shade(paint, 0.72 + 0.28 * along.max(round));
                Spot { height: 0.4 + 0.5 * round, paint, rough: 0.72, through: 0.3 }
            }
            None => Spot { height: 0.0, paint: mix(inks.dark, inks.light, 0.45), rough: 0.9, through: 0.3 },
        }
    }

    /// Returns the alpha of places without leaf: low but not 0 between needles, so that coarser copies of the texture,
    /// in which each pixel is the mean of many, are closed there and do not lose the needles.
    fn gap(&self, u: f64, v: f64) -> f64 {
        let p = self.chart.place(chart_place(DVec2::new(u, v)));
        let between = match self.tile {
            None => self.cut.between(p),
            Some(tile) => tile.leaves.iter().any(|l| self.cut.between(l.local(p))),
        };
        if between { GAP } else { 0.0 }
    }

    fn painted(&self, size: u32, run: &Run<'_>) -> Result<Surface, Cancelled> {
        let sheet = Sheet {
            size: (size, size),
            extent: (self.extent.x, self.extent.y),
            depth: LEAF_DEPTH * self.plan.extent.y * self.scale,
            tiles: false,
            mean: None,
        };
        let Surface { color, maps } = surface(run, &sheet, true, &|u, v| self.seen_at(u, v).spot)?;
        let pixel = 1.0 / f64::from(size);
        let rows = map_until_cancelled(run, size as usize, |j| {
            let v = j as f64 * pixel;
            let mut row = Vec::with_capacity(size as usize);
            for i in 0..size {
                let u = f64::from(i) * pixel;
                // Five samples a pixel, so that none is half covered.
                let part = |du: f64, dv: f64| {
                    f64::from(u8::from(self.seen_at(u + du * pixel, v + dv * pixel).covered))
                };
                let around = part(0.3, 0.1) + part(0.9, 0.3) + part(0.1, 0.7) + part(0.7, 0.9);
                let alpha = 0.2 * (around + part(0.5, 0.5));
                let alpha = alpha.max(self.gap(u + 0.5 * pixel, v + 0.5 * pixel));
                row.push((byte(alpha), self.seen_at(u + 0.5 * pixel, v + 0.5 * pixel).tilt));
            }
            row
        })?;
        let places: Vec<(u8, DVec2)> = rows.concat();
        let mut color = Arc::unwrap_or_clone(color);
        for (rgba, (alpha, _)) in color.pixels.chunks_exact_mut(4).zip(&places) {
            rgba[3] = *alpha;
        }
        let normal = maps.normal.map(|normal| {
            let mut normal = Arc::unwrap_or_clone(normal);
            for (rgba, (_, tilt)) in normal.pixels.chunks_exact_mut(4).zip(&places) {
                lean(&mut rgba[..3], *tilt);
            }
            Arc::new(normal)
        });
        Ok(Surface { color: Arc::new(color), maps: Maps { normal, ..maps } })
    }
}

/// Leans a normal, three bytes.
fn lean(rgb: &mut [u8], tilt: DVec2) {
    if tilt == DVec2::ZERO {
        return;
    }
    let wide = |b: u8| f64::from(b) / 127.5 - 1.0;
    let (x, y, z) = (wide(rgb[0]) + tilt.x, wide(rgb[1]) + tilt.y, wide(rgb[2]));
    let length = ops::hypot(ops::hypot(x, y), z).max(1e-9);
    rgb.copy_from_slice(&[x, y, z].map(|n| byte(0.5 + 0.5 * n / length)));
}

/// Joins cells into a grid.
fn joined(cells: &[Surface], size: u32) -> Surface {
    let columns = u32::try_from(columns(cells.len())).unwrap_or(1);
    let join = |of: &dyn Fn(&Surface) -> Option<Arc<Texture>>| {
        let parts: Vec<Arc<Texture>> = cells.iter().map(of).collect::<Option<_>>()?;
        let parts = parts.iter().map(|p| p.pixels.as_slice());
        Some(Arc::new(Texture::joined(parts, size, columns)))
    };
    let maps = Maps {
        normal: join(&|s| s.maps.normal.clone()),
        orm: join(&|s| s.maps.orm.clone()),
        height: None,
        through: join(&|s| s.maps.through.clone()),
    };
    let color = join(&|s| Some(Arc::clone(&s.color)));
    Surface { color: color.unwrap_or_else(|| Arc::clone(&cells[0].color)), maps }
}

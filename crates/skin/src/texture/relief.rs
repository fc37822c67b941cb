//! Paints a surface, given by its places, as colour, normals, occlusion and roughness, height.

use std::sync::{Arc, Mutex, PoisonError};

use base::{Cancelled, Digest, Run, map_until_cancelled};
use mesh::{Maps, Texture};

use super::{Paint, byte};

/// Properties of a surface at one place.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Spot {
    /// Height over the lowest place, 0 to 1.
    pub(super) height: f64,
    pub(super) paint: Paint,
    pub(super) rough: f64,
    /// Share of the light that a thin blade transmits, 0 to 1.
    pub(super) through: f64,
}

/// The sheet on which a surface is painted.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sheet {
    /// Size in pixels.
    pub(super) size: (u32, u32),
    /// Extent across and down, in one unit of length.
    pub(super) extent: (f64, f64),
    /// Depth that corresponds to a height of 1, in that unit.
    pub(super) depth: f64,
    /// Whether it repeats at its edges: bark.
    pub(super) tiles: bool,
    /// Mean colour that the result must have.
    pub(super) mean: Option<Paint>,
}

/// A surface as textures.
#[derive(Clone, Debug)]
pub(crate) struct Surface {
    pub(crate) color: Arc<Texture>,
    pub(crate) maps: Maps,
}

/// Bytes of painted surfaces that are kept: those of the trees of a session at their ordinary size.
const KEPT: usize = 96 << 20;

impl Surface {
    /// Returns the surface of this content, painted once and kept, if it was painted to its end; the oldest are dropped
    /// if there are too many.
    pub(crate) fn kept(
        content: Digest,
        paint: impl FnOnce() -> Result<Self, Cancelled>,
    ) -> Result<Self, Cancelled> {
        static KNOWN: Mutex<Vec<(String, Surface)>> = Mutex::new(Vec::new());
        let key = content.hex();
        let lock = || KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, surface)) = lock().iter().find(|(k, _)| *k == key) {
            return Ok(surface.clone());
        }
        // Not under the lock: the executor may paint other plants meanwhile.
        let surface = paint()?;
        let mut known = lock();
        known.push((key, surface.clone()));
        let bytes = |known: &[(String, Self)]| known.iter().map(|(_, s)| s.bytes()).sum::<usize>();
        while known.len() > 1 && bytes(&known) > KEPT {
            known.remove(0);
        }
        Ok(surface)
    }

    fn bytes(&self) -> usize {
        self.color.pixels.len() + self.maps.each().map(|t| t.pixels.len()).sum::<usize>()
    }
}

/// Rows that one job paints: about a millisecond.
const ROWS: u32 = 8;

/// Paints a surface; `at(u, v)` returns its properties, u to the right and v down, 0 to 1 each. The same bits for any
/// executor. `thin`: it transmits light.
pub(super) fn surface(
    run: &Run<'_>,
    sheet: &Sheet,
    thin: bool,
    at: &(dyn Fn(f64, f64) -> Spot + Sync),
) -> Result<Surface, Cancelled> {
    let (width, height) = sheet.size;
    let bands = map_until_cancelled(run, height.div_ceil(ROWS) as usize, |band| {
        let first = ROWS * u32::try_from(band).unwrap_or(u32::MAX);
        let mut spots = Vec::with_capacity((width * ROWS) as usize);
        for j in first..height.min(first.saturating_add(ROWS)) {
            let v = (f64::from(j) + 0.5) / f64::from(height);
            spots.extend((0..width).map(|i| Seen::from_spot(at((f64::from(i) + 0.5) / f64::from(width), v))));
        }
        spots
    })?;
    let spots = bands.concat();
    let color = colored(&spots, sheet);
    let heights = Heights::new(&spots, sheet);
    let bands = map_until_cancelled(run, height.div_ceil(ROWS) as usize, |band| {
        let first = ROWS as usize * band;
        let last = (first + ROWS as usize).min(height as usize);
        let mut both = (Vec::new(), Vec::new());
        for y in first..last {
            for x in 0..width as usize {
                let [r, g, b] = heights.normal(x, y, sheet).map(|n| byte(0.5 + 0.5 * n));
                both.0.extend_from_slice(&[r, g, b, 255]);
                let open = byte(heights.open(x, y));
                both.1.extend_from_slice(&[open, spots[y * width as usize + x].rough, 0, 255]);
            }
        }
        both
    })?;
    let texture = |pixels| Some(Arc::new(Texture { width, height, pixels }));
    let part = |k: usize| -> Vec<u8> {
        bands.iter().flat_map(|b| if k == 0 { b.0.iter() } else { b.1.iter() }).copied().collect()
    };
    let grey = |s: &Seen| {
        let h = byte(f64::from(s.height));
        [h, h, h, 255]
    };
    let maps = Maps {
        normal: texture(part(0)),
        orm: texture(part(1)),
        height: if thin { None } else { texture(spots.iter().flat_map(grey).collect()) },
        through: if thin {
            texture(spots.iter().flat_map(|s| [255, 255, 255, s.through]).collect())
        } else {
            None
        },
    };
    Ok(Surface { color: Arc::new(Texture { width, height, pixels: color }), maps })
}

/// A place as stored between the two passes.
#[derive(Clone, Copy, Debug)]
struct Seen {
    height: f32,
    paint: [f32; 3],
    rough: u8,
    through: u8,
}

impl Seen {
    fn from_spot(spot: Spot) -> Self {
        #[expect(clippy::cast_possible_truncation, reason = "0 to 1, and ends as bytes")]
        let narrow = |x: f64| x as f32;
        Self {
            height: narrow(spot.height.clamp(0.0, 1.0)),
            paint: spot.paint.map(narrow),
            rough: byte(spot.rough),
            through: byte(spot.through),
        }
    }
}

/// Returns RGBA, shifted to the requested mean.
fn colored(spots: &[Seen], sheet: &Sheet) -> Vec<u8> {
    #[expect(clippy::cast_precision_loss, reason = "a count of pixels")]
    let count = spots.len().max(1) as f64;
    let factor = sheet.mean.map_or([1.0; 3], |want| {
        [0, 1, 2].map(|k| {
            let sum: f64 = spots.iter().map(|s| f64::from(s.paint[k])).sum();
            (want[k] / (sum / count).max(1e-3)).clamp(0.1, 10.0)
        })
    });
    let pixel = |s: &Seen| {
        let [r, g, b] = [0, 1, 2].map(|k| byte(f64::from(s.paint[k]) * factor[k]));
        [r, g, b, 255]
    };
    spots.iter().flat_map(pixel).collect()
}

/// Cells of the coarser heights with which places are compared.
const CELLS: [usize; 2] = [128, 32];

struct Heights {
    fine: Vec<f32>,
    size: (usize, usize),
    tiles: bool,
    coarse: [Coarse; 2],
}

/// Mean heights of cells.
struct Coarse {
    size: (usize, usize),
    mean: Vec<f64>,
}

impl Heights {
    fn new(spots: &[Seen], sheet: &Sheet) -> Self {
        let size = (sheet.size.0 as usize, sheet.size.1 as usize);
        let fine: Vec<f32> = spots.iter().map(|s| s.height).collect();
        let coarse = CELLS.map(|n| {
            let cells = (n.min(size.0), n.min(size.1));
            let mut sum = vec![(0.0, 0.0); cells.0 * cells.1];
            for y in 0..size.1 {
                for x in 0..size.0 {
                    let cell = &mut sum[y * cells.1 / size.1 * cells.0 + x * cells.0 / size.0];
                    *cell = (cell.0 + f64::from(fine[y * size.0 + x]), cell.1 + 1.0);
                }
            }
            Coarse { size: cells, mean: sum.into_iter().map(|(h, n): (f64, f64)| h / n.max(1.0)).collect() }
        });
        Self { fine, size, tiles: sheet.tiles, coarse }
    }

    fn neighbour(&self, x: usize, y: usize, (dx, dy): (isize, isize)) -> f64 {
        let step = |x: usize, d: isize, n: usize| {
            let to = x.checked_add_signed(d);
            match to {
                Some(to) if to < n => to,
                _ if self.tiles => (x + n).saturating_add_signed(d) % n,
                _ => x,
            }
        };
        f64::from(self.fine[step(y, dy, self.size.1) * self.size.0 + step(x, dx, self.size.0)])
    }

    /// Returns a normal, red along u, green against v, blue outwards; each -1 to 1.
    fn normal(&self, x: usize, y: usize, sheet: &Sheet) -> [f64; 3] {
        let h = |dx, dy| self.neighbour(x, y, (dx, dy));
        let across = (h(1, 0) - h(-1, 0)) * f64::from(sheet.size.0) / (2.0 * sheet.extent.0);
        let down = (h(0, 1) - h(0, -1)) * f64::from(sheet.size.1) / (2.0 * sheet.extent.1);
        let (x, y) = (-across * sheet.depth, down * sheet.depth);
        let length = (x * x + y * y + 1.0).sqrt();
        [x / length, y / length, 1.0 / length]
    }

    /// Returns the visible share of the sky: less where the surroundings are higher.
    fn open(&self, x: usize, y: usize) -> f64 {
        let here = f64::from(self.fine[y * self.size.0 + x]);
        let at = |k: usize| (self.coarse[k].height_at(x, y, self.size, self.tiles) - here).max(0.0);
        (1.0 - 0.9 * at(0) - 0.7 * at(1)).clamp(0.25, 1.0)
    }
}

impl Coarse {
    fn height_at(&self, x: usize, y: usize, size: (usize, usize), tiles: bool) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "pixels")]
        let place = |x: usize, pixels: usize, cells: usize| {
            let at = (x as f64 + 0.5) * cells as f64 / pixels as f64 - 0.5;
            let low = super::whole(at.max(0.0));
            let (low, share) =
                if at < 0.0 { (if tiles { cells - 1 } else { 0 }, at + 1.0) } else { (low, at - low as f64) };
            let next = if low + 1 < cells {
                low + 1
            } else if tiles {
                0
            } else {
                low
            };
            (low, next, share)
        };
        let (x0, x1, tx) = place(x, size.0, self.size.0);
        let (y0, y1, ty) = place(y, size.1, self.size.1);
        let row =
            |y: usize| base::ops::lerp(self.mean[y * self.size.0 + x0], self.mean[y * self.size.0 + x1], tx);
        base::ops::lerp(row(y0), row(y1), ty)
    }
}

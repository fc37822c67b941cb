//! The tree of tiles with their boxes and errors.

use base::ops;
use glam::{DVec2, DVec3};
use mesh::Bounds;
use serde_json::{Value, json};

/// Precision of written boxes, metres; they are rounded outwards.
const STEP_M: f64 = 0.01;

/// Semi-major axis of the earth's ellipsoid, metres (WGS 84).
const EQUATOR_M: f64 = 6_378_137.0;
/// Its first eccentricity, squared (WGS 84).
const ECCENTRICITY: f64 = 6.694_379_990_141_316e-3;

/// A tile and the finer tiles that replace it nearby.
#[derive(Clone, Debug, PartialEq)]
pub struct TileNode {
    /// Bounding box of it and all below it, metres, +Y up.
    pub bounds: Bounds,
    /// Error of showing it instead of the tiles below, metres; 0 for the finest.
    pub geometric_error_m: f64,
    /// Path of its file, relative to that of the tileset.
    pub content: String,
    /// The tiles that replace it.
    pub children: Vec<Self>,
}

impl TileNode {
    /// Returns the number of tiles: itself and all below it.
    pub fn count(&self) -> usize {
        1 + self.children.iter().map(Self::count).sum::<usize>()
    }
}

/// Contents of a tileset.
#[derive(Clone, Debug, PartialEq)]
pub struct Tileset<'a> {
    /// The coarsest tile.
    pub root: &'a TileNode,
    /// Error of showing nothing, metres.
    pub geometric_error_m: f64,
    /// Frame of the origin on the earth, from [`earth_frame`]; none for a local place.
    pub transform: Option<[f64; 16]>,
    /// Place of the origin in the coordinates of the inventory: easting, height, northing in metres.
    pub origin_m: DVec3,
}

/// Returns the text of `tileset.json`, 3D Tiles 1.1: explicit tiles with boxes, `REPLACE`, +Z up.
///
/// Guaranteed: the same input gives the same bytes.
pub fn tileset_json(tileset: &Tileset<'_>) -> Vec<u8> {
    let mut root = tile(tileset.root);
    root["refine"] = "REPLACE".into();
    if let Some(transform) = tileset.transform {
        root["transform"] = json!(transform);
    }
    let DVec3 { x, y, z } = tileset.origin_m;
    let generator = concat!("Burgeon ", env!("CARGO_PKG_VERSION"));
    let whole = json!({
        "asset": {
            "version": "1.1",
            "extras": { "generator": generator, "origin_m": { "easting": x, "height": y, "northing": z } },
        },
        "geometricError": rounded(tileset.geometric_error_m),
        "root": root,
    });
    let mut text = whole.to_string().into_bytes();
    text.push(b'\n');
    text
}

fn tile(node: &TileNode) -> Value {
    let (low, high) = (node.bounds.min, node.bounds.max);
    // +Y up to +Z up.
    let turn = |p: DVec3| DVec3::new(p.x, -p.z, p.y);
    let (centre, half) = (turn(low + high) * 0.5, (high - low) * 0.5);
    let centre = centre.to_array().map(rounded);
    // Larger by as much as rounding may have moved the centre.
    let half = DVec3::new(half.x, half.z, half.y).to_array().map(|h| rounded(h + 2.0 * STEP_M));
    let [cx, cy, cz] = centre;
    let [hx, hy, hz] = half;
    let mut out = json!({
        "boundingVolume": { "box": [cx, cy, cz, hx, 0, 0, 0, hy, 0, 0, 0, hz] },
        "geometricError": rounded(node.geometric_error_m),
        "content": { "uri": node.content },
    });
    if !node.children.is_empty() {
        out["children"] = Value::Array(node.children.iter().map(tile).collect());
    }
    out
}

/// Rounds to whole steps, so that few digits are written.
fn rounded(x: f64) -> f64 {
    let steps = 1.0 / STEP_M;
    (x * steps).round() / steps
}

/// Returns the frame of east, north and up at a place of the earth, as 3D Tiles write transforms (column by column,
/// earth-centred coordinates of WGS 84). `place`: longitude and latitude in degrees, -180 to 180 and -90 to 90;
/// `height_m` above the ellipsoid.
///
/// ```
/// let frame = formats::earth_frame(glam::DVec2::new(0.0, 0.0), 0.0);
/// assert_eq!(&frame[12..15], &[6_378_137.0, 0.0, 0.0]);
/// assert_eq!(&frame[8..11], &[1.0, 0.0, 0.0], "up");
/// ```
pub fn earth_frame(place: DVec2, height_m: f64) -> [f64; 16] {
    let (sin_lon, cos_lon) = ops::sin_cos(place.x.to_radians());
    let (sin_lat, cos_lat) = ops::sin_cos(place.y.to_radians());
    let across = EQUATOR_M / (1.0 - ECCENTRICITY * sin_lat * sin_lat).sqrt();
    let out = (across + height_m) * cos_lat;
    [
        [-sin_lon, cos_lon, 0.0, 0.0],
        [-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat, 0.0],
        [cos_lat * cos_lon, cos_lat * sin_lon, sin_lat, 0.0],
        [out * cos_lon, out * sin_lon, (across * (1.0 - ECCENTRICITY) + height_m) * sin_lat, 1.0],
    ]
    .as_flattened()
    .try_into()
    .unwrap_or([0.0; 16])
}

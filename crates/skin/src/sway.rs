//! Wind as moving joints: one for each limb, from the columns for shaders.
//!
//! `model with wind columns -> Rig`

use std::collections::BTreeMap;

use base::{ops, turn};
use glam::{DQuat, DVec3};
use mesh::{Hold, Joint, Model, Rig};

use crate::sleeve::wide;

/// Returns the displacement of the top of a swaying plant, metres: a tenth of its height, off the axes so that no limb
/// is parallel to the wind.
pub fn gust(model: &Model) -> DVec3 {
    DVec3::new(0.0966, 0.0, 0.0258) * model.bounds().size().y
}

/// Most limbs with a joint of their own: those with the widest swing. The others move with the trunk.
const MOST_LIMBS: usize = 120;
/// Keys of a loop, the last as the first.
const KEYS: u32 = 33;
/// Angular frequency of the trunk, radians a second. The shader of the docs has 1.1; this one is commensurate with the
/// limbs.
const TRUNK: f64 = 1.15;
/// Angular frequency of the limbs, radians a second.
const LIMBS: f64 = 2.3;
/// Vertical share of a limb's swing: a limb that points into the wind moves, too.
const LIFT: f64 = 0.3;
/// Widest swing of a limb, radians: beyond it its stiffness would be visible.
const WIDEST: f64 = 0.35;

/// Data of a limb.
#[derive(Clone, Copy, Debug)]
struct Limb {
    foot: DVec3,
    /// The largest weight.
    most: f32,
    /// Centroid of its weight: sums of weighted positions and of weights.
    middle: DVec3,
    weight: f64,
}

/// Makes joints that move a model as the wind of its columns ([`SkinSpec::wind`](crate::SkinSpec::wind)) does, in a
/// loop of five and a half seconds: a static one at the ground, one that sways with the whole plant, and one at the
/// foot of each limb, at most 120 limbs. `gust` is the displacement of the top, metres; the shader of the docs has a
/// tenth of the height.
///
/// Guaranteed: vertices held by a limb's joint at its foot move as the bearer does there; shares of vertices add up to
/// 1; the last key is the first; the same bits everywhere. Not guaranteed: flutter of single leaves, for which a vertex
/// has no joint. `None` for a model without those columns. Cost: linear in vertices.
pub fn sway(model: &Model, gust: DVec3) -> Option<Rig> {
    let blown = |p: &&mesh::Part| !p.mesh.positions.is_empty();
    let complete = |p: &mesh::Part| {
        let n = p.mesh.positions.len();
        p.mesh.wind.len() == n && p.mesh.pivots.len() == n
    };
    if !model.parts.iter().filter(blown).all(complete) || model.parts.iter().all(|p| p.mesh.wind.is_empty()) {
        return None;
    }
    let height = top(model);
    if height.1 <= height.0 || !gust.is_finite() {
        return None;
    }
    let (ground, height) = (height.0, height.1 - height.0);
    let ground = DVec3::Y * ground;
    let limbs = limbs(model);
    let rows: BTreeMap<u32, u16> = (2_u16..).zip(&limbs).map(|(row, (phase, _))| (*phase, row)).collect();
    let hold = |wind: &[f32; 4]| {
        let (high, out) = (wind[0].max(0.0).sqrt(), wind[1].max(0.0).sqrt());
        let row = rows.get(&wind[3].to_bits()).copied();
        let out = row.map_or(0.0, |_| out);
        Hold {
            joints: [0, 1, row.unwrap_or(0), 0],
            shares: [(1.0 - out) * (1.0 - high), (1.0 - out) * high, out, 0.0],
        }
    };
    let still = Joint { name: "ground".to_owned(), at: ground };
    let trunk = Joint { name: "sway".to_owned(), at: ground };
    let own = limbs.iter().enumerate();
    let own = own.map(|(k, (_, limb))| Joint { name: format!("limb {}", k + 1), at: limb.foot });
    let whole = ops::TAU / TRUNK;
    let instants: Vec<f64> = (0..KEYS).map(|k| whole * f64::from(k) / f64::from(KEYS - 1)).collect();
    // The last key is the first to the bit.
    let at = |k: usize| if k + 1 == instants.len() { 0.0 } else { instants[k] };
    let lean = |k: usize| {
        let far = 0.6 + 0.4 * ops::sin(TRUNK * at(k));
        let across = DVec3::Y.cross(gust);
        across.try_normalize().map_or(DQuat::IDENTITY, |axis| turn::about(axis, far * gust.length() / height))
    };
    let moves = |(phase, limb): &(u32, Limb)| -> Vec<(DQuat, DVec3)> {
        let middle = limb.middle / limb.weight.max(f64::MIN_POSITIVE);
        let out = middle - limb.foot;
        let up = DVec3::Y * (LIFT * gust.length());
        let axis = out.cross(gust + up).try_normalize();
        // Where weights grow with the square of the length, their centroid is three quarters of the way out. The tip of
        // weight w is held by its joint with the root of w, and must move by w times the gust.
        let tip = out.length().max(1e-9) / 0.75;
        let wide = (f64::from(limb.most).sqrt() * gust.length() / tip).min(WIDEST);
        let phase = f64::from(f32::from_bits(*phase));
        (0..instants.len())
            .map(|k| {
                let swing = ops::sin(LIMBS * at(k) + ops::TAU * phase);
                let own = axis.map_or(DQuat::IDENTITY, |axis| turn::about(axis, wide * swing));
                let high = ((limb.foot.y - ground.y) / height).clamp(0.0, 1.0);
                let shift = (lean(k) * (limb.foot - ground) - (limb.foot - ground)) * high;
                (own, shift)
            })
            .collect()
    };
    let none = vec![(DQuat::IDENTITY, DVec3::ZERO); instants.len()];
    let swaying = (0..instants.len()).map(|k| (lean(k), DVec3::ZERO)).collect();
    #[expect(clippy::cast_possible_truncation, reason = "seconds of a file")]
    let seconds = instants.iter().map(|t| *t as f32).collect();
    Some(Rig {
        joints: [still, trunk].into_iter().chain(own).collect(),
        holds: model.parts.iter().map(|p| p.mesh.wind.iter().map(hold).collect()).collect(),
        seconds,
        moves: [none, swaying].into_iter().chain(limbs.iter().map(moves)).collect(),
    })
}

/// Returns the heights of the ground and of the top, by the weights of sway.
fn top(model: &Model) -> (f64, f64) {
    let bounds = model.bounds();
    let still = model.parts.iter().flat_map(|p| p.mesh.positions.iter().zip(&p.mesh.wind));
    // The highest place that does not sway is the ground.
    let ground =
        still.filter(|(_, w)| w[0] == 0.0).map(|(p, _)| f64::from(p[1])).fold(f64::NEG_INFINITY, f64::max);
    (if ground.is_finite() { ground } else { bounds.min.y }, bounds.max.y)
}

/// Returns the limbs by their phase, those with the widest swing first.
fn limbs(model: &Model) -> Vec<(u32, Limb)> {
    let mut found: BTreeMap<u32, Limb> = BTreeMap::new();
    for part in &model.parts {
        let mesh = &part.mesh;
        for ((p, wind), pivot) in mesh.positions.iter().zip(&mesh.wind).zip(&mesh.pivots) {
            // The pivot of wood is the foot of its limb; that of leaves is their own.
            let wood = wind[2] == 0.0 && !model.material(part).double_sided;
            if wind[1] <= 0.0 || !wood {
                continue;
            }
            let foot = wide(*pivot);
            let limb = found.entry(wind[3].to_bits()).or_insert(Limb {
                foot,
                most: 0.0,
                middle: DVec3::ZERO,
                weight: 0.0,
            });
            limb.most = limb.most.max(wind[1]);
            let weight = f64::from(wind[1]);
            limb.middle += wide(*p) * weight;
            limb.weight += weight;
        }
    }
    let mut limbs: Vec<(u32, Limb)> = found.into_iter().collect();
    base::sort_by(&mut limbs, |a, b| b.1.most.total_cmp(&a.1.most).then(a.0.cmp(&b.0)));
    limbs.truncate(MOST_LIMBS);
    limbs
}

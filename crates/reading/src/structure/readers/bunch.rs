//! A bunch (grapes, berries): round faces of one size, packed so that each touches several others, on a stalk that leads
//! up or aside.

use glam::DVec2;
use ink::StrokeClass;

use super::super::faces::Face;
use super::{Axis, Part, Proposal, Scene, adjoins};
use crate::Kind;
use crate::blade::nearest_on_ring;

/// Requirements of a bunch.
struct BunchLimits {
    /// Fewest round faces.
    fewest: usize,
    /// Least roundness of a face (width over length).
    round: f64,
    /// Least convexity of a round face.
    convex: f64,
    /// The smallest has at least this share of the area of the largest.
    alike: f64,
    /// They cover at least this share of the enclosed area; others are partly hidden.
    whole: f64,
    /// Each touches at least this many others, on average: petals round a disc touch it and two neighbours.
    neighbours: f64,
    /// The largest is not larger than this factor of the usual one: a disc has another size than its petals.
    largest: f64,
    /// A berry that is partly hidden has at least this share of the area of the usual one; gaps between berries have less.
    hidden: f64,
    /// See [`Proposal::likelihood`].
    likelihood: f64,
}

const BUNCH: BunchLimits = BunchLimits {
    fewest: 5,
    round: 0.8,
    convex: 0.88,
    alike: 0.5,
    whole: 0.7,
    neighbours: 2.0,
    largest: 1.5,
    hidden: 0.35,
    likelihood: 6000.0,
};

pub(super) fn propose(scene: &Scene) -> Option<Proposal> {
    let is_round = |f: &&Face| f.shape.slenderness > BUNCH.round && f.shape.convexity > BUNCH.convex;
    let berries: Vec<&Face> = scene.faces.iter().filter(is_round).collect();
    let mut areas: Vec<f64> = berries.iter().map(|f| f.shape.area).collect();
    base::sort_numbers(&mut areas);
    let (least, usual, most) = (*areas.first()?, areas[areas.len() / 2], *areas.last()?);
    let touching = |f: &&Face| berries.iter().filter(|g| !core::ptr::eq(*f, **g) && adjoins(f, g)).count();
    let contacts = || berries.iter().map(touching).sum::<usize>() as f64;
    if berries.len() < BUNCH.fewest
        || least < BUNCH.alike * most
        || most > BUNCH.largest * usual
        || areas.iter().sum::<f64>() < BUNCH.whole * scene.enclosed()
        || !hangs(scene)
        || contacts() <= BUNCH.neighbours * berries.len() as f64
    {
        return None;
    }
    let is_berry = |f: &&Face| f.shape.area > BUNCH.hidden * usual;
    let mut parts: Vec<Part> =
        scene.faces.iter().filter(is_berry).map(|f| Part::from_face(f, StrokeClass::Fruit, None)).collect();
    parts.extend(scene.axes.iter().map(Part::from_axis));
    let (heads, likelihood, word) = (Vec::new(), BUNCH.likelihood, Some("grapes"));
    Some(Proposal { kind: Kind::Fruit, parts, heads, likelihood, word, is_of_pieces: false })
}

/// Whether a line leads from the bunch upwards, and none down from it.
fn hangs(scene: &Scene) -> bool {
    let lowest = scene.faces.iter().flat_map(|f| &f.outline).map(|p| p.y).fold(f64::INFINITY, f64::min);
    let touches = |p: DVec2| scene.faces.iter().any(|f| nearest_on_ring(&f.outline, p).1 < scene.touch);
    let mut stalks = scene.axes.iter().map(Axis::ends);
    let leads_up = |[a, b]: [DVec2; 2]| {
        let (foot, end) = if touches(a) { (a, b) } else { (b, a) };
        touches(foot) && end.y > foot.y
    };
    stalks.any(leads_up) && scene.axes.iter().flat_map(|a| &a.points).all(|p| p.y > lowest)
}

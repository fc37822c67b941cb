//! Movement of each vertex in the wind: weights, phases and pivots.
//!
//! `chains, spines -> length along the wood from each limb's foot -> columns of tubes and organs`
//!
//! A *limb* is a branch that the main axis bears, with all that hangs on it. It moves as one: its wood and leaves share
//! one phase, and their weight grows with the length along the wood from the limb's foot, over all forks. So whatever a
//! shader makes of the weights, a branch cannot part from its bearer, nor a leaf from its twig. On main axes and roots
//! the weight is 0: they sway with the whole plant, by height.

use base::{Draw, Seed};
use glam::DVec3;
use mesh::{Bounds, TriMesh};
use plant::{AxisKind, NodeId, Organ, Plant, Shape};

use crate::fork::Bearer;
use crate::sleeve::{narrow, wide};
use crate::spine::{Reach, Spine};

/// Data of a chain of axes.
#[derive(Clone, Copy, Debug)]
struct Member {
    /// Length along the wood from the limb's foot to this chain's, metres; `None` if only the whole plant sways.
    from: Option<f64>,
    /// Arc length at which its centre line leaves its bearer.
    exit: f64,
    pivot: DVec3,
    phase: f32,
}

/// A chain as the input of the wind.
#[derive(Debug)]
pub(crate) struct Wood<'a> {
    /// Its bearer, and the chain of that.
    pub bearer: Option<(Bearer<'a>, usize)>,
    /// Its fillet on the bearer.
    pub reach: Option<Reach>,
    pub borne: bool,
    /// Key of its first axis.
    pub key: u64,
    pub spine: Option<&'a Spine>,
}

/// The wind in one plant.
#[derive(Debug)]
pub(crate) struct Wind<'a> {
    plant: &'a Plant,
    seed: Seed,
    ground: f64,
    height: f64,
    /// The greatest length from a limb's foot to a tip, or half of the height if that is more, metres.
    longest: f64,
    members: Vec<Member>,
    /// The chain of each axis, and the index of its first node among the chain's points.
    places: Vec<(usize, usize)>,
    /// Length from the limb's foot to each node.
    nodes: Vec<f64>,
}

impl<'a> Wind<'a> {
    /// Measures the plant. `woods` are the chains in their order, `places` gives the position of each axis.
    pub(crate) fn new(
        plant: &'a Plant,
        seed: Seed,
        bounds: &Bounds,
        woods: &[Wood<'_>],
        places: Vec<(usize, usize)>,
    ) -> Self {
        let mut wind = Self {
            plant,
            seed,
            ground: ground(plant, bounds),
            height: 0.0,
            longest: 0.0,
            members: Vec::with_capacity(woods.len()),
            places,
            nodes: vec![0.0; plant.nodes.position.len()],
        };
        wind.height = (bounds.max.y - wind.ground).max(0.0);
        // A leaf stalk may be the only limb of a herb: it must not swing as far as a bough.
        wind.longest = 0.5 * wind.height;
        // The axes of each chain, so that its nodes can be measured when its foot is.
        let mut axes: Vec<Vec<usize>> = vec![Vec::new(); woods.len()];
        for (axis, &(chain, _)) in wind.places.iter().enumerate() {
            if let Some(of_chain) = axes.get_mut(chain) {
                of_chain.push(axis);
            }
        }
        for (chain, wood) in woods.iter().enumerate() {
            let member = wind.member(chain, wood);
            wind.members.push(member);
            let (Some(from), Some(spine)) = (member.from, wood.spine) else { continue };
            wind.longest = wind.longest.max(from + (spine.length() - member.exit).max(0.0));
            for &axis in &axes[chain] {
                let (range, offset) = (&plant.axes[axis].nodes, wind.places[axis].1);
                for (node, local) in (range.start as usize..range.end as usize).zip(offset..) {
                    if let Some(way) = wind.nodes.get_mut(node) {
                        let s = spine.s.get(sample(spine, local)).copied().unwrap_or(0.0);
                        *way = from + (s - member.exit).max(0.0);
                    }
                }
            }
        }
        wind
    }

    fn member(&self, chain: usize, wood: &Wood<'_>) -> Member {
        let pivot = wood.spine.and_then(|s| s.p.first().copied()).unwrap_or(DVec3::ZERO);
        let own = Member { from: None, exit: 0.0, pivot, phase: self.phase(wood.key) };
        if !wood.borne {
            return own;
        }
        let limb = Member { from: Some(0.0), ..own };
        let Some((bearer, host)) = &wood.bearer else { return limb };
        let limb = Member { exit: wood.reach.map_or(0.0, |r| r.exit.s), ..limb };
        // A bearer comes before its branches; otherwise the branch is a limb of its own.
        let Some(host) = self.members.get(*host).filter(|_| *host < chain) else { return limb };
        let Some(start) = host.from else { return limb };
        let inside = || bearer.spine.s.get(bearer.sample).copied().unwrap_or(0.0);
        let s = wood.reach.map_or_else(inside, |r| r.on);
        Member { from: Some(start + (s - host.exit).max(0.0)), exit: limb.exit, ..*host }
    }

    fn way(&self, node: NodeId) -> f64 {
        self.nodes.get(node.index()).copied().unwrap_or(0.0)
    }

    fn phase(&self, key: u64) -> f32 {
        share(self.seed.child(key).stream(Draw::Wind).uniform())
    }

    /// Returns the sway of the whole plant at a height, like a mast held by the ground.
    fn sway(&self, y: f32) -> f32 {
        if self.height <= 0.0 {
            return 0.0;
        }
        let h = ((f64::from(y) - self.ground) / self.height).clamp(0.0, 1.0);
        share(h * h)
    }

    /// Returns the weight of a limb's sway, again like a mast, held at the limb's foot.
    fn reach(&self, way: f64) -> f32 {
        if self.longest <= 0.0 {
            return 0.0;
        }
        let t = (way / self.longest).clamp(0.0, 1.0);
        share(t * t)
    }

    /// Returns the least number of rows of vertices of a tube. Weights are curved along the wood and linear between
    /// rows: without enough of them a trunk would part from its branches.
    pub(crate) fn rows(&self, chain: usize, spine: &Spine) -> f64 {
        let (low, high) = spine.p.iter().fold((f64::MAX, f64::MIN), |(a, b), p| (a.min(p.y), b.max(p.y)));
        let of = |x: f64, whole: f64| if whole > 0.0 { (x / whole).clamp(0.0, 1.0) } else { 0.0 };
        let limb = self.members.get(chain).is_some_and(|m| m.from.is_some());
        let way = if limb { of(spine.length(), self.longest) } else { 0.0 };
        // (1/12)^2 / 4: chord and parabola differ by less than 1/500 of the whole movement.
        let rings = 12.0 * of(high - low, self.height).max(way);
        match rings {
            ..2.0 => 0.0,
            // The ends take 2 rows of few and up to 7 of many.
            ..7.0 => rings + 2.0,
            _ => rings + 7.0,
        }
    }

    /// Fills the columns of a chain's tube. `collar` is the number of rows of its fillet on `bearer`, which belongs to
    /// chain `host`.
    pub(crate) fn tube(
        &self,
        mesh: &mut TriMesh,
        chain: usize,
        spine: &Spine,
        sides: usize,
        fillet: Option<(usize, &Bearer<'_>, usize)>,
    ) {
        let member = self.members.get(chain).copied();
        let member = member.unwrap_or(Member { from: None, exit: 0.0, pivot: DVec3::ZERO, phase: 0.0 });
        let n = mesh.positions.len();
        mesh.pivots = vec![narrow(member.pivot); n];
        let ways = match member.from {
            Some(from) => self.ways(mesh, (from, member.exit), spine, sides, fillet),
            None => vec![0.0; n],
        };
        let rows = mesh.positions.iter().zip(&ways);
        mesh.wind = rows.map(|(p, &way)| [self.sway(p[1]), self.reach(way), 0.0, member.phase]).collect();
    }

    /// Returns the length from the limb's foot to each vertex of a tube, in the order in which `Sleeve` writes them.
    fn ways(
        &self,
        mesh: &TriMesh,
        (from, exit): (f64, f64),
        spine: &Spine,
        sides: usize,
        fillet: Option<(usize, &Bearer<'_>, usize)>,
    ) -> Vec<f64> {
        let n = mesh.positions.len();
        let width = sides + 1;
        // The foot, or the flat base, has one vertex more than its corners: the centre.
        let base = fillet.map_or(1 + sides, |(rows, ..)| rows * width + 1);
        let mut ways = vec![from; base.min(n)];
        let mut hint = 0;
        let mut top = from;
        // Rings, then one apex for each side.
        let rings = mesh.positions.get(base..n.saturating_sub(sides)).unwrap_or_default();
        for (k, ring) in rings.chunks(width).enumerate() {
            let corners = &ring[..sides.min(ring.len())];
            #[expect(clippy::cast_precision_loss, reason = "at most 64 sides")]
            let centre = corners.iter().copied().map(wide).sum::<DVec3>() / corners.len().max(1) as f64;
            let (s, near) = along(spine, centre, hint);
            hint = near;
            let way = from + (s - exit).max(0.0);
            if k == 0 {
                top = way;
            }
            ways.extend(core::iter::repeat_n(way, ring.len()));
        }
        ways.resize(n, from + (spine.length() - exit).max(0.0));
        if let Some((rows, bearer, host)) = fillet {
            // The foot moves with the bearer wherever it lies on it, the top with the branch.
            let held = self.members.get(host).and_then(|m| Some((m.from?, m.exit)));
            let mut near = bearer.sample;
            for (i, p) in mesh.positions.iter().enumerate().take(base) {
                let row = if i <= width { 0 } else { (i - 1) / width };
                let below = held.map_or(0.0, |(from, exit)| {
                    let (s, found) = along(bearer.spine, wide(*p), near);
                    near = found;
                    from + (s - exit).max(0.0)
                });
                #[expect(clippy::cast_precision_loss, reason = "a few rows")]
                let u = row as f64 / rows.max(1) as f64;
                ways[i] = base::ops::lerp(below, top, u);
            }
        }
        ways
    }

    /// Fills the columns of an organ, the vertices from `first` on; `flutter` has a weight for each of its shape's.
    pub(crate) fn organ(&self, mesh: &mut TriMesh, first: usize, organ: &Organ, flutter: &[f32]) {
        let member = organ.bearer.and_then(|b| {
            let axis = self.plant.nodes.axis.get(b.index())?;
            let member = self.members.get(self.places.get(axis.index())?.0)?;
            // It moves with its bearer: its own weight would tear it off.
            member.from.map(|_| (self.reach(self.way(b)), member.phase))
        });
        let (reach, phase) = member.unwrap_or_else(|| (0.0, self.phase(organ.key)));
        let pivot = narrow(organ.frame.origin);
        for (p, &z) in mesh.positions.get(first..).unwrap_or_default().iter().zip(flutter) {
            mesh.wind.push([self.sway(p[1]), reach, z, phase]);
            mesh.pivots.push(pivot);
        }
    }
}

/// Returns the flutter of each vertex of a shape, 0 to 1: a blade from its root (0) to its tip and margin, other shapes
/// not.
pub(crate) fn flutter(shape: &Shape, mesh: &TriMesh) -> Vec<f32> {
    let n = mesh.positions.len();
    if !matches!(shape, Shape::Blade(_) | Shape::Spline(_) | Shape::Sheet(_)) {
        return vec![0.0; n];
    }
    let far = mesh.positions.iter().map(|p| wide(*p).length()).fold(0.0, f64::max);
    let weight = |(i, p): (usize, &[f32; 3])| {
        let t = if far > 0.0 { (wide(*p).length() / far).min(1.0) } else { 0.0 };
        // The midrib, at the middle of the texture, is stiffer than the margin.
        let across = mesh.uvs.get(i).map_or(0.0, |uv| (2.0 * f64::from(uv[0]) - 1.0).abs().min(1.0));
        share(t * (1.0 - 0.5 * (1.0 - t) * (1.0 - across)))
    };
    mesh.positions.iter().enumerate().map(weight).collect()
}

/// Returns the height at which the plant leaves the ground: the lowest foot of an axis that stands on it; y = 0 if
/// there is none.
fn ground(plant: &Plant, bounds: &Bounds) -> f64 {
    let feet = plant.axes.iter().filter(|a| a.bearer.is_none() && a.kind != AxisKind::Root);
    let feet = feet.filter_map(|a| plant.nodes.position.get(a.nodes.start as usize));
    let low = feet.map(|p| p.y).filter(|y| y.is_finite() && y.abs() < 1e12).fold(f64::INFINITY, f64::min);
    if low.is_finite() {
        low
    } else if (bounds.min.y..=bounds.max.y).contains(&0.0) {
        0.0
    } else {
        bounds.min.y
    }
}

/// Returns the sample at an input point of a spine; dropped points have that of the next.
pub(crate) fn sample(spine: &Spine, input: usize) -> usize {
    let at = spine.knots.partition_point(|&(_, kept)| kept < input);
    spine.knots.get(at).or(spine.knots.last()).map_or(0, |&(sample, _)| sample)
}

/// Returns the arc length of the point of a spine nearest to `p`, and the hint for the next.
fn along(spine: &Spine, p: DVec3, hint: usize) -> (f64, usize) {
    let (station, piece) = spine.nearest(p, hint);
    (station.s, piece)
}

#[expect(clippy::cast_possible_truncation, reason = "f64 in the model, f32 in the mesh, by design")]
fn share(x: f64) -> f32 {
    x.clamp(0.0, 1.0) as f32
}

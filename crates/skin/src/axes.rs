//! Converts axes to tubes: axes that continue one another become one tube, the others grow out of their bearers.

use base::{Cancelled, Counted, Run, Stopped, map_indexed};
use glam::DVec3;
use mesh::TriMesh;
use plant::{Axis, AxisId, AxisKind, NodeId, Plant};

use crate::coloured::Coloured;
use crate::fork::{Bearer, Collar, reach};
use crate::hollow::Opening;
use crate::rings::{drawn, planes, rings};
use crate::sleeve::{Circle, Ribs, Sleeve, drop_flat};
use crate::spec::{Budget, SkinSpec};
use crate::spine::{Reach, Spine};
use crate::stub_end::{End, follow, lay_bark};
use crate::traced::Traced;
use crate::wind::{self, Wind, Wood};

/// Part of the model that an axis belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Surface {
    Bark,
    /// Thin branches, still smooth.
    YoungBark,
    /// Face at the end of a stub: no bark.
    DeadWood,
    Stem,
    /// Green and thick: the body and arms of a cactus.
    Flesh,
    Root,
}

impl Surface {
    fn for_axis(plant: &Plant, axis: &Axis) -> Self {
        match axis.kind {
            AxisKind::Branch | AxisKind::Twig | AxisKind::Stub => Self::Bark,
            AxisKind::Root if on_the_ground(plant, axis) => Self::Bark,
            AxisKind::Root => Self::Root,
            // Stem, petiole, and future kinds that are not known to be woody.
            _ => Self::Stem,
        }
    }
}

/// Whether a root of a woody stem runs along the ground: in the light, with the bark of the stem.
fn on_the_ground(plant: &Plant, root: &Axis) -> bool {
    let rows = root.nodes.start as usize..root.nodes.end as usize;
    let Some([a, .., b]) = plant.nodes.position.get(rows) else { return false };
    let course = *b - *a;
    let host = |axis: &Axis| plant.nodes.axis.get(axis.bearer?.index()).map(|&host| plant.axis(host));
    let mut bearer = host(root);
    while let Some(further) = bearer.filter(|a| a.kind == AxisKind::Root) {
        bearer = host(further);
    }
    course.y.abs() < LEVEL * course.length() && bearer.is_some_and(|a| a.kind == AxisKind::Branch)
}

/// Axes that follow one another tip to base, meshed as one tube.
#[derive(Debug)]
struct Chain {
    axes: Vec<AxisId>,
    bearer: Option<NodeId>,
    surface: Surface,
    /// A leaf stalk: thin and one of many.
    stalk: bool,
    root: bool,
    /// The remains of a branch.
    stub: bool,
    /// Whether roots leave its foot.
    rooted: bool,
}

impl Chain {
    /// Whether it is neither a root nor the remains of a branch.
    fn is_shoot(&self) -> bool {
        !self.root && !self.stub
    }
}

/// One finished tube.
#[derive(Debug)]
pub(crate) struct Tube {
    pub surface: Surface,
    pub traced: bool,
    /// Its axes, in order.
    pub axes: Vec<AxisId>,
    pub mesh: TriMesh,
}

/// Bearer of a chain: a chain, and the sample of its spine.
type Host = (usize, usize);

/// Position of an axis: its chain, and the index of its first node among the chain's points.
type Place = (usize, usize);

// Number of tubes in a group: one job each would cost more than the tube.
const GROUP: usize = 16;

// Share of the thickest branch's radius below which branches are young: no plates yet.
const YOUNG: f64 = 0.12;
// Share of the plant's size below which its thickest branch means that it has no old wood.
const SLENDER: f64 = 0.02;

// Widening of a trunk at the ground, and its height in radii: where roots leave it, and without.
const SKIRT: (f64, f64) = (0.6, 3.5);
const COLLAR: (f64, f64) = (0.25, 2.0);

// Largest slope of a root on the ground, as a share of its length: 20 degrees.
const LEVEL: f64 = 0.35;

// Sides of a tube with ribs: two for each of the greatest number of ribs.
const MOST_SIDES: u32 = 64;

// Height of the bark ridge in a crotch, relative to the spread of the fillet.
const RIDGE: f64 = 0.25;

// Least number of sides of the rim of a hollow, which is seen from near by.
const ROUND: u32 = 18;

// Detail below which ribs are only painted.
const COARSE: f64 = 0.3;

// Share of the plant's size above which green axes are bodies, not stems.
const FLESHY: f64 = 0.035;

/// Makes the tubes of every axis, in the order of the axes; and the wind in them, if requested.
///
/// # Errors
/// [`Stopped`].
pub(crate) fn tubes<'p>(
    plant: &'p Plant,
    spec: &SkinSpec,
    budget: &Budget,
    traced: Option<&Traced>,
    run: &Run<'_>,
) -> Result<(Vec<Tube>, Option<Wind<'p>>), Stopped> {
    let (chains, places) = chains(plant);
    // A tube has at least four rows of three sides.
    run.budget.check(Counted::Triangles, 24 * chains.len() as u64, crate::FEWER)?;
    let spines = grouped(run, chains.len(), |i| spine(plant, &chains[i], budget))?;
    let thickest = spines.iter().flatten().map(Spine::stout).fold(0.0, f64::max);
    let least = |i: usize| if chains[i].stalk { spec.sides.min(5) } else { spec.sides };
    let sides: Vec<u32> = spines
        .iter()
        .enumerate()
        .map(|(i, s)| s.as_ref().map_or(3, |s| budget.sides(s.r[0], least(i))))
        .collect();
    let (ribs, sides, faces) = ribbed(&chains, &spines, spec, thickest, sides);
    // Circles for every possible number of sides: 3 to 24, and more for tubes with ribs.
    let most = if ribs.iter().any(|r| r.count > 0) { MOST_SIDES } else { 24 };
    let circles: Vec<Circle> = (0..=most).map(Circle::new).collect();
    let borne_by = |chain: &Chain| {
        let node = chain.bearer?;
        let axis = *plant.nodes.axis.get(node.index())?;
        let &(host, offset) = places.get(axis.index())?;
        let local = node.index().checked_sub(plant.axis(axis).nodes.start as usize)? + offset;
        Some((host, wind::sample(spines.get(host)?.as_ref()?, local)))
    };
    let mut hosts: Vec<Option<Host>> = chains.iter().map(borne_by).collect();
    let smooth = |borne: Option<Host>| {
        let (host, sample) = borne?;
        Some(Bearer {
            spine: spines[host].as_ref()?,
            sample,
            sides: faces[host],
            exit: 0.0,
            top: 0.0,
            planes: &[],
        })
    };
    let leaves = |i: usize, borne| reach(spines[i].as_ref()?, &smooth(borne)?);
    let mut reaches = grouped(run, chains.len(), |i| leaves(i, hosts[i]))?;
    for i in 0..chains.len() {
        let outer = outermost(i, &spines, &reaches, &hosts);
        if outer != hosts[i] {
            (hosts[i], reaches[i]) = (outer, leaves(i, outer));
        }
    }
    let wind = spec.wind.then(|| {
        let wood = |i: usize| Wood {
            bearer: smooth(hosts[i]).zip(hosts[i]).map(|(bearer, (host, _))| (bearer, host)),
            reach: reaches[i],
            borne: chains[i].bearer.is_some() && !chains[i].root,
            key: chains[i].axes.first().map_or(0, |&a| plant.axis(a).key),
            spine: spines[i].as_ref(),
        };
        let woods: Vec<Wood<'_>> = (0..chains.len()).map(wood).collect();
        Wind::new(plant, spec.seed, &crate::bounds(plant), &woods, places.clone())
    });
    let mut bears = vec![false; chains.len()];
    for (host, _) in hosts.iter().flatten() {
        bears[*host] = true;
    }
    let lines = grouped(run, chains.len(), |i| {
        let spine = spines[i].as_ref()?;
        let least = wind.as_ref().map_or(0.0, |w| w.rows(i, spine));
        let rows = rows(budget, &chains[i], spine.length()).max(least);
        let bare = budget.unseen(spine.stoutest()) && !bears[i];
        let ends = if bare { Ends::bare(rows) } else { Ends::divide(rows, sides[i]) };
        let reach = reaches[i];
        let (line, first) = drawn(spine, reach.as_ref(), ends.rings, |radius| budget.tolerance(radius));
        let planes = if bears[i] { planes(&line, first) } else { Vec::new() };
        Some(Line { line, first, planes, reach, ends })
    })?;
    let sleeves = lines.iter().zip(&sides).map(|(line, sides)| {
        let Some(Line { line, first, ends, .. }) = line else { return 0 };
        let rows = (line.p.len() - first) as u64 + u64::from(ends.steps + ends.tip);
        2 * u64::from(*sides) * rows
    });
    run.budget.check(Counted::Triangles, sleeves.sum(), crate::FEWER)?;
    let coloured = Coloured::new(plant);
    let openings = Vec::new();
    let mut all = All {
        plant,
        budget,
        chains,
        spines,
        lines,
        hosts,
        faces,
        thickest,
        traced,
        wind,
        coloured,
        openings,
    };
    all.openings = all.find_openings();
    let sides = |i: usize| if all.is_hollow(i) { sides[i].max(ROUND) } else { sides[i] };
    let tubes =
        grouped(run, all.chains.len(), |i| all.tubes_of(i, circles.get(sides(i) as usize)?, ribs[i]))?;
    Ok((tubes.into_iter().flatten().flatten().flatten().collect(), all.wind))
}

/// Input for the tubes of all chains; rows by chain.
struct All<'a, 'p> {
    plant: &'p Plant,
    budget: &'a Budget,
    chains: Vec<Chain>,
    spines: Vec<Option<Spine>>,
    lines: Vec<Option<Line>>,
    hosts: Vec<Option<Host>>,
    /// Number of sides that each presents to its branches.
    faces: Vec<u32>,
    thickest: f64,
    traced: Option<&'a Traced>,
    wind: Option<Wind<'p>>,
    coloured: Option<Coloured<'p>>,
    /// Hollows: by chain of the rim, the chain of its stem.
    openings: Vec<(usize, usize, Opening)>,
}

impl All<'_, '_> {
    /// Makes the tube of a chain, and the face of a stub.
    fn tubes_of(&self, i: usize, circle: &Circle, ribs: Ribs) -> Option<[Option<Tube>; 2]> {
        let (chain, spine, line) = (&self.chains[i], self.spines[i].as_ref()?, self.lines[i].as_ref()?);
        let bearer = self.hosts[i].and_then(|(host, sample)| {
            Some(self.lines[host].as_ref()?.bearer(self.spines[host].as_ref()?.s[sample], self.faces[host]))
        });
        let surface = surface(chain, spine, self.thickest, self.budget);
        let repeats = if surface == Surface::Bark { repeats(spine, self.thickest) } else { 1 };
        let end = match self.openings.iter().find(|(rim, ..)| *rim == i) {
            Some((_, _, opening)) => End::Hollow(*opening),
            None => end(self.plant, chain, spine, line),
        };
        let barked = matches!(surface, Surface::Bark | Surface::YoungBark) && chain.is_shoot();
        let ridge = if barked { RIDGE } else { 0.0 };
        let (mut mesh, fillet, face) = sleeve(line, bearer.as_ref(), circle, (repeats, ribs), (end, ridge));
        if let (true, Some(reach), Some((host, _))) =
            (chain.stub && !end.is_broken(), line.reach, self.hosts[i])
            && let Some(host) = &self.spines[host]
        {
            let at = host.station_at(reach.on);
            let scale = f64::from(self::repeats(host, self.thickest)) / (base::ops::TAU * at.radius);
            lay_bark(&mut mesh, &reach.exit, &at, scale);
        }
        if let Some(wind) = &self.wind {
            let fillet =
                fillet.zip(bearer.as_ref()).zip(self.hosts[i]).map(|((rows, b), (host, _))| (rows, b, host));
            wind.tube(&mut mesh, i, spine, circle.sides(), fillet);
        }
        let traced = self.traced.filter(|t| chain.axes.iter().all(|&a| t.has(self.plant.axis(a).source)));
        if let Some(traced) = traced {
            traced.tube(&mut mesh, spine);
        }
        if let Some(coloured) = &self.coloured {
            coloured.tube(&mut mesh, &chain.axes, spine);
        }
        for (_, _, opening) in self.openings.iter().filter(|(_, host, _)| *host == i) {
            opening.cut(&mut mesh);
        }
        let tube = |surface, mesh| Tube { surface, traced: traced.is_some(), axes: chain.axes.clone(), mesh };
        let face = face.map(|mut face| {
            follow(&mut face, &mesh);
            tube(Surface::DeadWood, face)
        });
        Some([Some(tube(surface, mesh)), face])
    }

    /// Whether a chain is the rim of a hollow.
    fn is_hollow(&self, i: usize) -> bool {
        self.openings.iter().any(|(rim, ..)| *rim == i)
    }

    /// Finds the rims of stems that are hollow behind them.
    fn find_openings(&self) -> Vec<(usize, usize, Opening)> {
        let of = |i: usize| {
            let (chain, spine, line) = (&self.chains[i], self.spines[i].as_ref()?, self.lines[i].as_ref()?);
            let End::Rim(_) = end(self.plant, chain, spine, line) else { return None };
            let (host, reach) = (self.hosts[i]?.0, line.reach.as_ref()?);
            let stem = self.spines[host].as_ref()?.station_at(reach.on);
            let key = self.plant.axis(*chain.axes.first()?).key;
            // The foot of a stem is drawn wider than it grew.
            let grown = *self.plant.nodes.radius_m.get(chain.bearer?.index())?;
            let share = spine.stout() / grown.max(f64::MIN_POSITIVE);
            let opening = Opening::new(&reach.exit, &stem, (key, share), self.budget.detail)?;
            self.chains[host].is_shoot().then_some((i, host, opening))
        };
        let found: Vec<_> = (0..self.chains.len()).filter(|&i| self.chains[i].stub).filter_map(of).collect();
        let others =
            |i: usize, host: usize| found.iter().filter(move |(rim, on, _)| *rim != i && *on == host);
        let beside = |&(i, host, opening): &(usize, usize, Opening)| {
            (i, host, others(i, host).fold(opening, |opening, (.., other)| opening.crowded_by(other)))
        };
        found.iter().map(beside).collect()
    }
}

/// Returns the surface of a chain, by its thickness relative to the thickest and to the whole plant. Roots are as old
/// as the stem.
fn surface(chain: &Chain, spine: &Spine, thickest: f64, budget: &Budget) -> Surface {
    match chain.surface {
        Surface::Bark
            if chain.is_shoot() && spine.stout() < YOUNG * thickest.max(SLENDER * budget.size()) =>
        {
            Surface::YoungBark
        }
        Surface::Stem if spine.stoutest() > FLESHY * budget.size() => Surface::Flesh,
        surface => surface,
    }
}

/// Returns for each chain its ribs, the sides that they take, and the number of sides that its surface presents to its
/// branches, for which a furrow is as deep as a flat face.
fn ribbed(
    chains: &[Chain],
    spines: &[Option<Spine>],
    spec: &SkinSpec,
    thickest: f64,
    sides: Vec<u32>,
) -> (Vec<Ribs>, Vec<u32>, Vec<u32>) {
    let ribs: Vec<Ribs> =
        chains.iter().zip(spines).map(|(c, s)| ribs(c, s.as_ref(), spec, thickest)).collect();
    // A rib takes four corners, or two at coarse detail.
    let of_rib = if spec.detail >= 0.8 { 4 } else { 2 };
    let of = |(sides, r): (u32, &Ribs)| if r.count > 0 { (of_rib * r.count).min(MOST_SIDES) } else { sides };
    let sides: Vec<u32> = sides.into_iter().zip(&ribs).map(of).collect();
    let faces =
        sides.iter().zip(&ribs).map(|(sides, r)| r.faces().map_or(*sides, |f| f.min(*sides))).collect();
    (ribs, sides, faces)
}

/// Returns the ribs of a chain: for thick stems, if they are requested and not too fine to be drawn.
fn ribs(chain: &Chain, spine: Option<&Spine>, spec: &SkinSpec, thickest: f64) -> Ribs {
    let bark = spec.bark.unwrap_or_default();
    let thick = spine.is_some_and(|s| s.stout() > YOUNG * thickest);
    if bark.ribs < 3 || spec.detail < COARSE || chain.surface != Surface::Bark || !thick {
        return Ribs::default();
    }
    Ribs { count: bark.ribs.min(32), depth: bark.rib_depth.clamp(0.0, 0.5) }
}

/// Returns the bearer of chain `i`: if it begins while its bearer is still inside the next thicker one, that one.
fn outermost(
    i: usize,
    spines: &[Option<Spine>],
    reaches: &[Option<Reach>],
    hosts: &[Option<Host>],
) -> Option<Host> {
    let start = spines[i].as_ref()?.p[0];
    let mut found = hosts[i]?;
    while let (host, sample) = found
        && let (Some(inside), Some((next, hint))) = (&reaches[host], hosts[host])
        && let (Some(spine), Some(wood)) = (&spines[host], &spines[next])
        && spine.s[sample] < inside.exit.s
        && next < host
    {
        found = (next, wood.nearest(start, hint).1);
    }
    Some(found)
}

/// As [`map_indexed`], in groups, with a check for cancellation before each.
fn grouped<T: Send>(run: &Run<'_>, n: usize, f: impl Fn(usize) -> T + Sync) -> Result<Vec<T>, Cancelled> {
    let groups = map_indexed(run.executor, n.div_ceil(GROUP), |g| {
        run.cancel.check()?;
        Ok((g * GROUP..n.min((g + 1) * GROUP)).map(&f).collect::<Vec<T>>())
    });
    let mut out = Vec::with_capacity(n);
    for group in groups {
        out.extend(group?);
    }
    Ok(out)
}

/// Rows of a tube: of its fillet, between its ends, and of its tip.
#[derive(Clone, Copy, Debug)]
struct Ends {
    steps: u32,
    rings: f64,
    tip: u32,
}

impl Ends {
    /// Returns the rows of a last twig that is too thin to be seen: as few as its course takes.
    fn bare(rows: f64) -> Self {
        Self { steps: 0, rings: (rows - 2.0).max(2.0), tip: 0 }
    }

    /// Divides the rows of a tube with this number of sides.
    fn divide(rows: f64, sides: u32) -> Self {
        // A thick tube's tip is large enough to show its corners.
        let round = if sides > 12 { 4 } else { 2 };
        // Small twigs spend fewer rows on their ends, so that some are left for the middle; limbs get more of them.
        let short = rows < 9.0;
        let (steps, tip) = if short && sides < 7 { (1, 1) } else { (3, round) };
        let spent = if short { 2 } else { steps + tip };
        Self { steps, rings: (rows - f64::from(spent)).max(3.0), tip }
    }
}

/// A chain as drawn: bearers are straight between rings.
#[derive(Debug)]
struct Line {
    line: Spine,
    /// Index of its first ring.
    first: usize,
    /// Planes of its rings; empty if it bears nothing.
    planes: Vec<DVec3>,
    reach: Option<Reach>,
    ends: Ends,
}

impl Line {
    /// Returns it as the bearer of a branch at an arc length.
    fn bearer(&self, s: f64, sides: u32) -> Bearer<'_> {
        let [exit, top] = self.reach.map_or([0.0; 2], |r| [r.exit.s, r.top]);
        Bearer { spine: &self.line, sample: self.line.piece(s), sides, exit, top, planes: &self.planes }
    }
}

/// Returns the repetitions of bark around a branch: three around the thickest, so that its ridges have similar size on
/// all.
fn repeats(spine: &Spine, thickest: f64) -> u32 {
    base::ops::whole((3.0 * spine.stout() / thickest).round()).clamp(1, 3)
}

/// Returns the end of a chain.
fn end(plant: &Plant, chain: &Chain, spine: &Spine, line: &Line) -> End {
    let Some((&last, &axis)) = spine.r.last().zip(chain.axes.first()).filter(|_| chain.stub) else {
        return End::Round;
    };
    let beyond = spine.length() - line.reach.as_ref().map_or(0.0, |r| r.exit.s);
    End::from_stub(plant.axis(axis).key, beyond, spine.stout(), last)
}

/// Makes one tube: fillet or flat base, rings, and its end. Also returns the number of the fillet's rows below the
/// first ring, and the part of the end without bark.
fn sleeve(
    line: &Line,
    bearer: Option<&Bearer<'_>>,
    circle: &Circle,
    (repeats, ribs): (u32, Ribs),
    (end, ridge): (End, f64),
) -> (TriMesh, Option<usize>, Option<TriMesh>) {
    let Ends { steps, tip, .. } = line.ends;
    let mut rings = rings(&line.line, line.first);
    let mut mesh = TriMesh::default();
    let capacity = (circle.sides() + 1) * (rings.len() + (steps + tip) as usize + 2);
    mesh.positions.reserve(capacity);
    mesh.normals.reserve(capacity);
    mesh.uvs.reserve(capacity);
    mesh.triangles.reserve(2 * capacity);
    let mut out = Sleeve::new(&mut mesh, circle, repeats).ribbed(ribs);
    let fillet = line.reach.as_ref().zip(bearer).map(|(reach, bearer)| {
        let collar = Collar::new(reach, &rings[0], bearer, circle, (steps, ridge));
        collar.write(&mut out, rings[0].radius, !matches!(end, End::Hollow(_)));
        steps as usize + 1
    });
    if fillet.is_none() {
        // It ends inside the bearer, so it starts where that is drawn.
        if let Some(bearer) = bearer {
            rings[0].centre = bearer.spine.nearest(rings[0].centre, bearer.sample).0.centre;
        }
        out.flat_base(&rings[0]);
    }
    out.rings(&rings);
    let face = end.close(&mut out, &rings[rings.len() - 1], circle, tip);
    drop_flat(&mut mesh);
    (mesh, fillet, face)
}

/// Returns the rings of a chain; stalks get a third.
fn rows(budget: &Budget, chain: &Chain, length: f64) -> f64 {
    let rows = budget.rings(length);
    if chain.stalk { (0.35 * rows).max(4.0) } else { rows }
}

/// Returns the axes of each tube of a plant's surface, each of which continues the one before. Cost: linear.
///
/// ```
/// use glam::DVec3;
/// use plant::{AxisKind, Plant};
/// let mut p = Plant::default();
/// let stem = p.add_axis(AxisKind::Stem, None, 1, &[DVec3::ZERO, DVec3::Y], None);
/// let tip = p.axis(stem).node_ids().next_back();
/// p.add_axis(AxisKind::Stem, tip, 2, &[DVec3::Y, DVec3::Y * 2.0], None);
/// p.add_axis(AxisKind::Stem, tip, 3, &[DVec3::Y, DVec3::Y + DVec3::X], None);
/// p.nodes.radius_m = vec![0.1; 6];
/// assert_eq!(skin::tubes_of(&p).iter().map(Vec::len).collect::<Vec<_>>(), [2, 1]);
/// ```
pub fn tubes_of(plant: &Plant) -> Vec<Vec<AxisId>> {
    chains(plant).0.into_iter().map(|chain| chain.axes).collect()
}

/// Groups axes that continue their bearer's tip; also returns the position of each axis.
fn chains(plant: &Plant) -> (Vec<Chain>, Vec<Place>) {
    let n = plant.axes.len();
    let heir = heirs(plant);
    let mut chains: Vec<Chain> = Vec::with_capacity(n);
    let mut places: Vec<Place> = vec![(usize::MAX, 0); n];
    let mut rooted = vec![false; n];
    for axis in plant.axes.iter().filter(|a| a.kind == AxisKind::Root && on_the_ground(plant, a)) {
        if let Some(host) = axis.bearer.and_then(|b| plant.nodes.axis.get(b.index())) {
            rooted[host.index()] = true;
        }
    }
    for i in 0..n {
        if places[i].0 != usize::MAX {
            continue;
        }
        let id = AxisId::new(i);
        let axis = plant.axis(id);
        let mut chain = Chain {
            axes: vec![id],
            bearer: axis.bearer,
            surface: Surface::for_axis(plant, axis),
            stalk: axis.kind == AxisKind::Petiole,
            root: axis.kind == AxisKind::Root,
            stub: axis.kind == AxisKind::Stub,
            rooted: rooted[i],
        };
        places[i] = (chains.len(), 0);
        let mut offset = axis.nodes.len();
        let mut tip = i;
        while let Some(next) = heir[tip] {
            // The heir's first node coincides with the bearer's last, which represents both.
            places[next] = (chains.len(), offset - 1);
            offset += plant.axes[next].nodes.len() - 1;
            chain.axes.push(AxisId::new(next));
            tip = next;
        }
        chains.push(chain);
    }
    (chains, places)
}

/// Returns for each axis the one that continues it: borne by its last node, of the same surface, not turning away by
/// more than 65 degrees, the thickest and straightest of them.
fn heirs(plant: &Plant) -> Vec<Option<usize>> {
    let mut heir: Vec<Option<(f64, usize)>> = vec![None; plant.axes.len()];
    for (i, axis) in plant.axes.iter().enumerate() {
        let Some(bearer) = axis.bearer else { continue };
        let Some(&host) = plant.nodes.axis.get(bearer.index()) else { continue };
        // A bearer comes before its branches: chains cannot close to a ring.
        if host.index() >= i || plant.axis(host).nodes.end as usize != bearer.index() + 1 {
            continue;
        }
        if Surface::for_axis(plant, plant.axis(host)) != Surface::for_axis(plant, axis)
            || axis.nodes.len() < 2
        {
            continue;
        }
        let (a, b) = (end_direction(plant, host), start_direction(plant, AxisId::new(i)));
        let cos = a.dot(b);
        let radius = plant.axis_radii(AxisId::new(i)).first().copied().unwrap_or(0.0);
        let tip = plant.axis_radii(host).last().copied().unwrap_or(0.0);
        // cos 65 degrees; and a thin stalk on a stout end is a stalk, not the continuation of the stem.
        if cos < 0.42 || radius < 0.45 * tip {
            continue;
        }
        let score = radius * cos;
        if heir[host.index()].is_none_or(|(best, _)| score > best) {
            heir[host.index()] = Some((score, i));
        }
    }
    heir.into_iter().map(|h| h.map(|(_, i)| i)).collect()
}

fn start_direction(plant: &Plant, id: AxisId) -> DVec3 {
    direction(plant.axis_points(id).iter())
}

fn end_direction(plant: &Plant, id: AxisId) -> DVec3 {
    -direction(plant.axis_points(id).iter().rev())
}

/// Returns the direction from the first point to the first one that differs.
fn direction<'a>(mut points: impl Iterator<Item = &'a DVec3>) -> DVec3 {
    let Some(&a) = points.next() else { return DVec3::Y };
    points.find_map(|&b| (b - a).try_normalize()).unwrap_or(DVec3::Y)
}

fn spine(plant: &Plant, chain: &Chain, budget: &Budget) -> Option<Spine> {
    let mut points: Vec<DVec3> = Vec::new();
    let mut radii: Vec<f64> = Vec::new();
    for (k, &id) in chain.axes.iter().enumerate() {
        let (p, r) = (plant.axis_points(id), plant.axis_radii(id));
        if k == 0 {
            points.extend_from_slice(p);
            radii.extend_from_slice(r);
        } else {
            // At the joint the radii of tip and heir meet in the middle.
            if let (Some(tip), Some(first)) = (radii.last_mut(), r.first()) {
                *tip = 0.5 * (*tip + *first);
            }
            points.extend_from_slice(p.get(1..)?);
            radii.extend_from_slice(r.get(1..)?);
        }
    }
    let length = geom_length(&points);
    let rows = rows(budget, chain, length);
    // A branch leaves slightly in its bearer's direction before it takes its own.
    let first = chain.bearer.and_then(|node| {
        let host = *plant.nodes.axis.get(node.index())?;
        let range = &plant.axis(host).nodes;
        let (a, b) = (node.index().checked_sub(1)?, node.index() + 1);
        let a = a.max(range.start as usize);
        let b = b.min((range.end as usize).checked_sub(1)?);
        let along = (*plant.nodes.position.get(b)? - *plant.nodes.position.get(a)?).try_normalize()?;
        let own = start_direction(plant, chain.axes[0]);
        let forward = own.dot(along) > -0.3;
        (forward && own.is_finite()).then(|| (own + along * 0.3).normalize_or(own))
    });
    let mut spine = Spine::new(&points, &radii, 4 * base::ops::whole(rows) as usize, first)?;
    if chain.bearer.is_none() && chain.surface == Surface::Bark {
        spine.root_flare(if chain.rooted { SKIRT } else { COLLAR });
        spine.stand();
    }
    Some(spine)
}

fn geom_length(points: &[DVec3]) -> f64 {
    points.windows(2).map(|w| w[0].distance(w[1])).filter(|d| d.is_finite()).fold(0.0, |sum, d| sum + d)
}

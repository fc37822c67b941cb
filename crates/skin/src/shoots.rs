//! Leaves as cards with holes: of one leaf, or of several leaves of a shoot; and the position of each in the plant's
//! atlas.
//!
//! `Plant -> clusters of leaves -> a few of them flat, to be painted | a card for each cluster`

use base::{Digest, Seed};
use glam::{DVec2, DVec3};
use mesh::TriMesh;
use plant::{Blade, Frame, Lift, Organ, OrganKind, Plant, Relief, Shape, ShapeId};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::blade::BladeChart;
use crate::needles::Cut;
use crate::sleeve::{drop_flat, narrow2};

/// Share of the wood of a card that counts as covered: thin twigs are lost in a texture (64 pixels of an oak show
/// hardly any of them), the stalks of palm leaves are not.
const WOOD_SEEN: f64 = 0.5;

/// Drawing of leaves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FoliageStyle {
    /// By their outlines.
    #[default]
    Outlines,
    /// By cards of six corners, with the leaf cut out of their texture.
    Cards,
    /// By outlines in the finest level, by cards in the next, and by cards of whole shoots in those that are coarser.
    ByLevel,
}

/// Leaves of a painted shoot: few enough to be recognisable, and enough to represent a twig.
const LEAVES: usize = 12;
/// Quantiles of the spread of the leaves in a cluster at which shoots are chosen for painting: dense ones, because
/// spread ones leave a card empty.
const DENSE: [f64; 3] = [0.10, 0.25, 0.45];
/// Fold of a card of a shoot, like a roof, so that it is visible from its edge, too.
const FOLD: f64 = -0.35;
/// Half of the thickness of the wood of a shoot, as a share of its length; half of that for stalks.
const WOOD: f64 = 0.005;
/// Samples along a side by which the cover of a shoot is measured.
const SAMPLES: u32 = 128;
/// Margin that stays free on each side of a cell of the atlas, as a share of it: coarser copies of a texture mix
/// neighbours.
const MARGIN: f64 = 1.0 / 64.0;

/// A leaf of a shoot in its plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FlatLeaf {
    /// Its root.
    pub(crate) at: DVec2,
    /// Unit vector from root to tip.
    pub(crate) along: DVec2,
    pub(crate) scale: f64,
    /// Lean of its normal, across and along the card.
    pub(crate) tilt: DVec2,
    /// Light: 1 at the top, less below others.
    pub(crate) lit: f64,
}

impl FlatLeaf {
    /// Converts from the shoot's plane to the leaf's own.
    pub(crate) fn local(&self, p: DVec2) -> DVec2 {
        let d = (p - self.at) / self.scale;
        DVec2::new(d.x * self.along.y - d.y * self.along.x, d.dot(self.along))
    }

    /// Converts from the leaf's own plane to the shoot's.
    fn place(&self, p: DVec2) -> DVec2 {
        self.at + (DVec2::new(self.along.y, -self.along.x) * p.x + self.along * p.y) * self.scale
    }
}

/// A painted shoot.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tile {
    /// Its card.
    pub(crate) card: Blade,
    /// Its leaves, the lowest first.
    pub(crate) leaves: Vec<FlatLeaf>,
    /// Lines of wood: from, to.
    pub(crate) wood: Vec<[DVec2; 2]>,
    /// Middle of the leaves.
    middle: DVec2,
    /// Area covered by leaves and visible wood, square metres.
    covered: f64,
}

/// The shoots of a plant in its atlas.
#[derive(Clone, Debug, PartialEq)]
pub struct Shoots {
    pub(crate) leaf: Blade,
    /// The places of its plane that are leaf.
    pub(crate) cut: Cut,
    pub(crate) tiles: Vec<Tile>,
    /// Index of the cards of the tiles among the shapes of a plant whose leaves are drawn as shoots.
    shape: usize,
}

/// Returns the part of the atlas of `cells` cells that shows cell `k`: from u, from v, width, height.
pub(crate) fn part(k: usize, cells: usize) -> [f64; 4] {
    let columns = columns(cells);
    let size = 1.0 / columns as f64;
    let (column, row) = ((k % columns) as f64, (k / columns) as f64);
    let (inner, edge) = (size * (1.0 - 2.0 * MARGIN), size * MARGIN);
    [column * size + edge, row * size + edge, inner, inner]
}

/// Returns the cells along a side of an atlas.
pub(crate) fn columns(cells: usize) -> usize {
    if cells > 1 { 2 } else { 1 }
}

/// Converts a position within a cell to one in its chart.
pub(crate) fn chart_place(uv: DVec2) -> DVec2 {
    (uv - MARGIN) / (1.0 - 2.0 * MARGIN)
}

impl Shoots {
    /// Finds the shoots of a plant with leaves of one flat form, which may be shoots in needles; `None` if there are
    /// few leaves, or no such form.
    ///
    /// Cost: n log n in leaves, and some 10 ms for measuring the area of shoots.
    pub fn find(plant: &Plant) -> Option<Self> {
        let (shape, leaf) = leaf_shape(plant)?;
        let cut = Cut::new(&leaf);
        let leaves = leaves_of(plant, shape);
        let mut clusters = clusters(plant, &leaf, leaves, LEAVES);
        if clusters.len() < 2 * DENSE.len() {
            return None;
        }
        let spread = |c: &Vec<usize>| {
            let middles: Vec<DVec3> = c.iter().map(|&i| middle(&plant.organs[i], &leaf)).collect();
            let mean = middles.iter().sum::<DVec3>() / middles.len() as f64;
            middles.iter().map(|m| m.distance_squared(mean)).sum::<f64>() / middles.len() as f64
        };
        let mut by_spread: Vec<(f64, usize)> = clusters.iter().map(spread).zip(0..).collect();
        base::sort_by(&mut by_spread, |a, b| a.0.total_cmp(&b.0));
        let tiles = DENSE.iter().filter_map(|share| {
            let rank = base::ops::whole(share * by_spread.len() as f64) as usize;
            let members = core::mem::take(&mut clusters[by_spread[rank].1]);
            tile(plant, &leaf, &cut, &members)
        });
        let tiles: Vec<Tile> = tiles.collect();
        (tiles.len() == DENSE.len()).then_some(Self { leaf, cut, tiles, shape: plant.shapes.len() })
    }

    /// The same shoots for another plant, whose leaves have the same form, so that the atlases of both are equal; none for one with
    /// other leaves or few.
    pub fn lent(&self, plant: &Plant) -> Option<Self> {
        let (shape, leaf) = leaf_shape(plant)?;
        let is_leafy = leaves_of(plant, shape).len() >= LEAVES * 2 * DENSE.len();
        (is_leafy && leaf == self.leaf).then(|| Self { shape: plant.shapes.len(), ..self.clone() })
    }

    /// Takes the leaves of `plant`, of which these are the shoots, out of it and puts cards of `shoots` times 12
    /// leaves each in their places.
    ///
    /// Guaranteed: together the cards show as much leaf area as the leaves have. Cards are leaves with the keys of one
    /// of theirs.
    pub fn stand_in(&self, plant: &mut Plant, shoots: usize) {
        let Some((shape, leaf)) = leaf_shape(plant) else { return };
        let leaves = leaves_of(plant, shape);
        let area = geom::signed_area(&leaf.outline).abs();
        let cards: Vec<Organ> = clusters(plant, &leaf, leaves, LEAVES * shoots.max(1))
            .iter()
            .filter_map(|members| {
                let frame = frame(plant, &leaf, members)?;
                let first = members.iter().map(|&i| &plant.organs[i]).min_by_key(|o| o.key)?;
                let mixed = Seed::new(first.key).child(1).number() % self.tiles.len().max(1) as u64;
                let row = usize::try_from(mixed).unwrap_or(0);
                let tile = self.tiles.get(row)?;
                let scales = members.iter().map(|&i| plant.organs[i].scale);
                let wanted = area * scales.map(|s| s * s).sum::<f64>();
                let scale = (wanted / tile.covered).sqrt();
                let off = (frame.right * tile.middle.x + frame.along * tile.middle.y) * scale;
                let shape = ShapeId::new(self.shape + row);
                let frame = Frame { origin: frame.origin - off, ..frame };
                Some(Organ { shape, frame, scale, ..first.clone() })
            })
            .collect();
        plant.organs.retain(|o| o.kind != OrganKind::Leaf || o.shape != shape || !sound(o));
        plant.organs.extend(cards);
        plant.shapes.truncate(self.shape);
        plant.shapes.extend(self.tiles.iter().map(|t| Shape::Blade(t.card.clone())));
    }

    /// Returns the tile of a shape.
    pub(crate) fn tile(&self, shape: usize) -> Option<(usize, &Tile)> {
        let row = shape.checked_sub(self.shape)?;
        self.tiles.get(row).map(|t| (row, t))
    }

    pub(crate) fn digest(&self, d: &mut Digest) {
        for tile in &self.tiles {
            d.add(&tile.card.outline);
            for leaf in &tile.leaves {
                d.add(&leaf.at).add(&leaf.along).add(&leaf.scale).add(&leaf.tilt).add(&leaf.lit);
            }
            tile.wood.iter().flatten().for_each(|p| {
                d.add(p);
            });
        }
    }
}

impl Tile {
    /// Returns the share of its card's area that is leaf, 0 to 1.
    pub(crate) fn share(&self) -> f64 {
        (self.covered / geom::signed_area(&self.card.outline).abs().max(f64::MIN_POSITIVE)).min(1.0)
    }

    /// Whether a point of the plane is on the wood.
    pub(crate) fn on_wood(&self, p: DVec2) -> bool {
        let thick = WOOD * self.card.length();
        self.wood.iter().enumerate().any(|(k, [a, b])| {
            let ab = *b - *a;
            let t = ((p - *a).dot(ab) / ab.length_squared().max(1e-18)).clamp(0.0, 1.0);
            p.distance(*a + ab * t) < if k == 0 { thick } else { 0.5 * thick }
        })
    }

    /// Returns the visible leaf at a point of the plane.
    pub(crate) fn seen(&self, leaf: &Cut, p: DVec2) -> Option<(&FlatLeaf, DVec2)> {
        self.leaves.iter().rev().find_map(|flat| {
            let own = flat.local(p);
            leaf.has(own).then_some((flat, own))
        })
    }
}

/// Returns the flat form of the most leaves.
fn leaf_shape(plant: &Plant) -> Option<(ShapeId, Blade)> {
    let mut counts = vec![0_usize; plant.shapes.len()];
    for organ in plant.organs.iter().filter(|o| o.kind == OrganKind::Leaf && sound(o)) {
        if let (Some(n), Some(Shape::Blade(_))) =
            (counts.get_mut(organ.shape.index()), plant.shapes.get(organ.shape.index()))
        {
            *n += 1;
        }
    }
    let (row, n) = counts.iter().enumerate().max_by_key(|&(row, n)| (*n, core::cmp::Reverse(row)))?;
    match plant.shapes.get(row) {
        Some(Shape::Blade(blade)) if *n > 0 && blade.length() > 0.0 => {
            Some((ShapeId::new(row), blade.clone()))
        }
        _ => None,
    }
}

fn leaves_of(plant: &Plant, shape: ShapeId) -> Vec<usize> {
    let is = |o: &Organ| o.kind == OrganKind::Leaf && o.shape == shape && sound(o);
    (0..plant.organs.len()).filter(|&i| is(&plant.organs[i])).collect()
}

fn sound(organ: &Organ) -> bool {
    let f = &organ.frame;
    let finite = [f.origin, f.right, f.along, f.normal].iter().all(|v| v.is_finite());
    finite && organ.scale.is_finite() && organ.scale > 0.0
}

fn middle(organ: &Organ, leaf: &Blade) -> DVec3 {
    organ.frame.origin + organ.frame.along * (0.5 * leaf.length() * organ.scale)
}

/// Groups neighbouring leaves, `most` or slightly fewer in each: halves of halves across their greatest extent.
fn clusters(plant: &Plant, leaf: &Blade, leaves: Vec<usize>, most: usize) -> Vec<Vec<usize>> {
    let mut done = Vec::new();
    let mut open = vec![(leaves.len().div_ceil(most.max(1)), leaves)];
    while let Some((parts, mut members)) = open.pop() {
        if parts <= 1 {
            if !members.is_empty() {
                done.push(members);
            }
            continue;
        }
        let at = |i: usize| middle(&plant.organs[i], leaf);
        let (low, high) = members
            .iter()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), &i| (l.min(at(i)), h.max(at(i))));
        let axis = (high - low).max_position();
        base::sort_by(&mut members, |&a, &b| at(a)[axis].total_cmp(&at(b)[axis]));
        let first = parts / 2;
        let rest = members.split_off(members.len() * first / parts);
        open.push((parts - first, rest));
        open.push((first, members));
    }
    done
}

/// Returns the plane of a cluster: through the centre of its leaves, along their mean direction, and facing as one of
/// them does.
fn frame(plant: &Plant, leaf: &Blade, members: &[usize]) -> Option<Frame> {
    let organs = || members.iter().map(|&i| &plant.organs[i]);
    let n = members.len() as f64;
    let centre = organs().map(|o| middle(o, leaf)).sum::<DVec3>() / n;
    let along = organs().map(|o| o.frame.along).sum::<DVec3>() / n;
    let first = organs().min_by_key(|o| o.key)?;
    let along = if along.length() > 0.1 { along } else { first.frame.along };
    Some(Frame::looking(centre, along, first.frame.normal))
}

/// Makes a cluster for painting: its leaves turned into its plane.
fn tile(plant: &Plant, leaf: &Blade, cut: &Cut, members: &[usize]) -> Option<Tile> {
    let frame = frame(plant, leaf, members)?;
    let mut deep: Vec<(f64, &Organ)> =
        members.iter().map(|&i| &plant.organs[i]).map(|o| (frame.localise(middle(o, leaf)).z, o)).collect();
    base::sort_by(&mut deep, |a, b| a.0.total_cmp(&b.0));
    let still = Frame { origin: DVec3::ZERO, ..frame };
    let flat = |v: DVec3| still.localise(v);
    let count = deep.len().max(2) as f64;
    let mut leaves: Vec<FlatLeaf> = deep
        .iter()
        .zip(0_u32..)
        .map(|(&(_, o), rank)| {
            let root = frame.localise(o.frame.origin).truncate();
            // A leaf that points out of the plane is turned to its side.
            let aside = DVec2::new(if root.x < 0.0 { -0.6 } else { 0.6 }, 0.8);
            let way = flat(o.frame.along).truncate();
            let along = if way.length() > 0.25 { way.normalize() } else { aside };
            let normal = flat(o.frame.normal);
            let normal = if normal.z < 0.0 { -normal } else { normal };
            let tilt = (normal.truncate() / normal.z.max(0.5)).clamp(DVec2::splat(-0.4), DVec2::splat(0.4));
            let lit = 0.78 + 0.22 * f64::from(rank) / (count - 1.0);
            FlatLeaf { at: root, along, scale: o.scale, tilt, lit }
        })
        .collect();
    // The lowest root is the foot of the shoot.
    let corners = |l: &FlatLeaf| leaf.outline.iter().map(|p| l.place(*p)).collect::<Vec<_>>();
    let low = leaves.iter().flat_map(&corners).map(|p| p.y).fold(f64::INFINITY, f64::min);
    leaves.iter_mut().for_each(|l| l.at.y -= low);
    let points: Vec<DVec2> = leaves.iter().flat_map(corners).collect();
    let high = points.iter().map(|p| p.y).fold(0.0, f64::max);
    let tops = leaves.iter().map(|l| l.at.y).fold(0.0, f64::max);
    let mut wood = vec![[DVec2::ZERO, DVec2::new(0.0, tops)]];
    // Leaves far from the middle belong to other twigs.
    let near = |l: &&FlatLeaf| l.at.x.abs() < leaf.length() * l.scale;
    let stalk = |l: &FlatLeaf| [DVec2::new(0.0, (l.at.y - 0.6 * l.at.x.abs()).max(0.0)), l.at];
    wood.extend(leaves.iter().filter(near).map(stalk));
    let [right, left] = [1.0, -1.0].map(|side| {
        let own: Vec<DVec2> = points.iter().map(|p| DVec2::new(p.x * side, p.y)).collect();
        half(&own, 0.0, high)
    });
    let mirror = |p: DVec2| DVec2::new(-p.x, p.y);
    let outline =
        vec![DVec2::ZERO, right[0], right[1], DVec2::new(0.0, high), mirror(left[1]), mirror(left[0])];
    if high.is_nan() || high <= 0.0 || geom::signed_area(&outline) <= 0.0 {
        return None;
    }
    let midrib = vec![DVec2::ZERO, DVec2::new(0.0, 0.5 * high), DVec2::new(0.0, high)];
    let relief = Relief { fold: FOLD, ..Relief::default() };
    let needles = leaf.needles;
    let card = Blade { outline, midrib, veins: Vec::new(), needles, lift: Lift::Flat, relief };
    let middle = leaves.iter().map(|l| l.at + l.along * (0.5 * leaf.length() * l.scale)).sum::<DVec2>()
        / leaves.len() as f64;
    let mut tile = Tile { card, leaves, wood, middle, covered: 0.0 };
    let leaves = covered(&tile.card, |p| tile.seen(cut, p).is_some());
    let all = covered(&tile.card, |p| tile.seen(cut, p).is_some() || tile.on_wood(p));
    tile.covered = leaves + WOOD_SEEN * (all - leaves);
    (tile.covered > 0.0).then_some(tile)
}

/// Returns the visible area of a card, square metres.
fn covered(card: &Blade, is_seen: impl Fn(DVec2) -> bool) -> f64 {
    let chart = BladeChart::new(card);
    let at = |i: u32| (f64::from(i) + 0.5) / f64::from(SAMPLES);
    let seen = |&(i, j): &(u32, u32)| is_seen(chart.place(DVec2::new(at(i), at(j))));
    let all = (0..SAMPLES).flat_map(|j| (0..SAMPLES).map(move |i| (i, j)));
    let size = chart.place(DVec2::new(1.0, 0.0)) - chart.place(DVec2::new(0.0, 1.0));
    all.filter(seen).count() as f64 / f64::from(SAMPLES * SAMPLES) * (size.x * size.y).abs()
}

/// Returns the two corners on the right of a card from `low` to `high` on its middle line that contains the points with
/// x above 0: the intersections of the lines from both ends, as near to the points as possible, with the widest place.
fn half(points: &[DVec2], low: f64, high: f64) -> [DVec2; 2] {
    let wide = points.iter().map(|p| p.x).fold(0.0, f64::max).max(1e-6 * (high - low));
    let steep = |rise: f64, x: f64| rise.max(0.0) / x;
    let own = || points.iter().filter(|p| p.x > 1e-3 * wide);
    let up = own().map(|p| steep(p.y - low, p.x)).fold(f64::INFINITY, f64::min);
    let down = own().map(|p| steep(high - p.y, p.x)).fold(f64::INFINITY, f64::min);
    let (from, to) = ((low + up * wide).min(high), (high - down * wide).max(low));
    let (from, to) = if from < to { (from, to) } else { (low, high) };
    [DVec2::new(wide, from), DVec2::new(wide, to)]
}

/// Meshes a blade as a card: two halves along its midrib, of two triangles each, around its outline. Its texture is in
/// this part of an atlas.
pub(crate) fn card_mesh(blade: &Blade, part: [f64; 4]) -> TriMesh {
    let mut mesh = TriMesh::default();
    if blade.outline.len() < 3 || blade.outline.iter().any(|p| !p.is_finite()) {
        return mesh;
    }
    let chart = BladeChart::new(blade);
    let surface = blade.surface();
    let flat: Vec<DVec2> = blade.outline.iter().map(|p| chart.uv(*p)).collect();
    let [right, left] = [1.0, -1.0].map(|side| {
        let own: Vec<DVec2> = flat.iter().map(|p| DVec2::new(side * (p.x - 0.5), p.y)).collect();
        half(&own, 0.0, 1.0).map(|p| DVec2::new(0.5 + side * p.x, p.y))
    });
    // In the picture y runs down: `half` begins at the tip.
    let places = [DVec2::new(0.5, 1.0), right[1], right[0], DVec2::new(0.5, 0.0), left[0], left[1]];
    for uv in places {
        let uv = uv.clamp(DVec2::ZERO, DVec2::ONE);
        let p = chart.place(uv);
        let lifted = surface.point(p);
        mesh.push(if lifted.is_finite() { lifted } else { p.extend(0.0) });
        mesh.uvs.push(narrow2(part[0] + part[2] * uv.x, part[1] + part[3] * uv.y));
    }
    mesh.triangles = vec![[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]];
    drop_flat(&mut mesh);
    mesh.compute_normals();
    mesh
}

/// Returns the share of a card of a blade that is leaf, 0 to 1.
pub(crate) fn leaf_share(blade: &Blade) -> f64 {
    let flat = Blade { relief: Relief::default(), lift: Lift::Flat, ..blade.clone() };
    let mesh = card_mesh(&flat, [0.0, 0.0, 1.0, 1.0]);
    let area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| mesh.position(i));
        0.5 * (b - a).cross(c - a).length()
    };
    let card: f64 = mesh.triangles.iter().map(area).sum();
    let leaf = if blade.needles.is_some() {
        let cut = Cut::new(blade);
        covered(blade, |p| cut.has(p))
    } else {
        geom::signed_area(&blade.outline).abs()
    };
    (leaf / card.max(f64::MIN_POSITIVE)).min(1.0)
}

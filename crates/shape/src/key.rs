//! Names of branches that survive edits and, where the branch is still there, a change of seed or setting.
//!
//! `AxisKey + plant -> the branch and how surely it was found, or the reason why not`

use glam::DVec3;
use plant::{AxisId, AxisKind, Plant};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::draft::Draft;
use crate::outcome::Why;

/// Names one axis of a plant.
///
/// Guaranteed: a [`Mark`](Self::Mark) of an axis finds this axis again in the same plant, after edits of other
/// branches, and (by its `id`) after a change of seed or setting where the maker keeps its keys, as drawn strokes do.
/// Where the keys are new it finds the branch most like the marked one: base, direction, length and order must all be
/// near, else it reports that the branch is gone. Not guaranteed: that the most similar branch is the one that a person
/// would choose, where two are alike; and that a `Path` or `Near` means the same branch in another plant.
///
/// ```
/// use glam::DVec3;
/// use plant::{AxisId, AxisKind, Plant};
/// use shape::AxisKey;
/// let mut p = Plant::default();
/// let trunk = p.add_axis(AxisKind::Branch, None, 1, &[DVec3::ZERO, DVec3::Y, DVec3::Y * 2.0], None);
/// let fork = p.axis(trunk).node_ids().nth(1);
/// let limb = p.add_axis(AxisKind::Branch, fork, 2, &[DVec3::Y, DVec3::new(1.0, 1.5, 0.0)], None);
/// let key = AxisKey::for_axis(&p, limb).ok_or("no such axis")?;
/// assert_eq!(key.find(&p).map(|f| f.axis), Ok(limb));
/// assert_eq!(AxisKey::Path(vec![0, 0]).find(&p).map(|f| f.axis), Ok(limb));
/// assert!(AxisKey::Path(vec![0, 1]).find(&p).is_err());
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum AxisKey {
    /// Mark that a program remembers of a picked axis.
    Mark(Mark),
    /// Path by number, as people write it into a file: the stem of the plant, its branch from the base up, and so on,
    /// all from 0. Stalks of leaves and roots do not count.
    Path(Vec<u32>),
    /// The axis nearest to this point, metres.
    Near(#[schemars(with = "[f64; 3]")] DVec3),
}

/// Mark by which an axis is remembered. Lengths are shares of the plant's size (the diagonal of the box around its
/// axes).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mark {
    /// The axis's own key, hexadecimal.
    pub id: String,
    /// Woody or green, stalk or root.
    pub kind: KindWord,
    /// Order of branching, 0 for a trunk.
    pub order: u32,
    /// Position of its base.
    #[schemars(with = "[f64; 3]")]
    pub base: DVec3,
    /// Direction from base to tip, a unit vector.
    #[schemars(with = "[f64; 3]")]
    pub direction: DVec3,
    /// Length along its course.
    pub length: f64,
}

/// [`AxisKind`] as it is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum KindWord {
    /// Trunk, branch or twig.
    Wood,
    /// Green stem.
    Stem,
    /// Stalk of a leaf.
    Petiole,
    /// Below ground.
    Root,
}

impl From<AxisKind> for KindWord {
    fn from(kind: AxisKind) -> Self {
        match kind {
            AxisKind::Stem => Self::Stem,
            AxisKind::Petiole => Self::Petiole,
            AxisKind::Root => Self::Root,
            // Branch, twig, and later kinds that are not known to be green.
            _ => Self::Wood,
        }
    }
}

/// An axis that was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// The axis.
    pub axis: AxisId,
    /// Whether its own key had changed, so that it is the branch most like the marked one.
    pub by_likeness: bool,
}

// Limits of likeness, found by eye on oaks of neighbouring seeds and settings: within them a person recognises the
// branch.
/// Largest distance of the bases of two like branches, as a share of the plant's size: an eighth.
const FAR_BASE: f64 = 0.125;
/// Largest angle between two like branches, radians: 40 degrees.
const FAR_ANGLE: f64 = 40.0 * (base::ops::PI / 180.0);
/// Largest difference of the logarithms of the lengths of two like branches: a factor of 2.5.
const FAR_LENGTH: f64 = 0.916; // ln 2.5

impl AxisKey {
    /// Returns the key of an axis; `None` if there is no such axis. Cost: linear in the plant.
    pub fn for_axis(plant: &Plant, axis: AxisId) -> Option<Self> {
        (axis.index() < plant.axes.len()).then(|| Self::Mark(mark(&Draft::new(plant), axis.index())))
    }

    /// Returns the path of every shoot that has one, in the order of the axes. Cost: n log n in axes.
    pub fn paths(plant: &Plant) -> Vec<(AxisId, Vec<u32>)> {
        let draft = Draft::new(plant);
        let mut siblings: Vec<Vec<usize>> = vec![Vec::new(); draft.branches.len()];
        let mut stems = Vec::new();
        for (i, b) in draft.branches.iter().enumerate().filter(|(_, b)| b.is_shoot()) {
            match b.bearer {
                Some(at) => siblings[at.branch].push(i),
                None => stems.push(i),
            }
        }
        for all in &mut siblings {
            base::sort_by_key(all, |&i| (draft.branches[i].bearer.map(|at| at.node), i));
        }
        let mut paths: Vec<Option<Vec<u32>>> = vec![None; draft.branches.len()];
        for (number, &stem) in (0..).zip(&stems) {
            paths[stem] = Some(vec![number]);
        }
        for b in draft.order() {
            let Some(own) = paths[b].clone() else { continue };
            for (number, &child) in (0..).zip(&siblings[b]) {
                paths[child] = Some(own.iter().copied().chain([number]).collect());
            }
        }
        let named = paths.into_iter().enumerate();
        named.filter_map(|(i, path)| Some((AxisId::new(i), path?))).collect()
    }

    /// Finds the axis. Cost: linear in the plant.
    ///
    /// # Errors
    /// [`Why`]: the axis does not exist.
    pub fn find(&self, plant: &Plant) -> Result<Found, Why> {
        let (branch, by_likeness) = self.find_in(&Draft::new(plant))?;
        Ok(Found { axis: AxisId::new(branch), by_likeness })
    }

    /// Checks that its numbers are usable.
    pub(crate) fn check(&self) -> Result<(), Why> {
        let (field, sound) = match self {
            Self::Mark(m) => {
                let finite = m.base.is_finite() && m.direction.is_finite() && m.length.is_finite();
                ("mark", finite && m.id.len() <= 16)
            }
            // Longer than the branching order of any plant.
            Self::Path(path) => ("path", path.len() <= 1000),
            Self::Near(p) => ("near", p.is_finite()),
        };
        if sound { Ok(()) } else { Err(Why::BadNumber { field }) }
    }

    pub(crate) fn find_in(&self, draft: &Draft) -> Result<(usize, bool), Why> {
        match self {
            Self::Mark(mark) => find_like(draft, mark),
            Self::Path(path) => find_path(draft, path).map(|b| (b, false)),
            Self::Near(p) => find_near(draft, *p).map(|b| (b, false)),
        }
    }
}

/// Returns the orders of all branches, 0 for those on the ground.
fn orders(draft: &Draft) -> Vec<u32> {
    let mut orders = vec![0; draft.branches.len()];
    for b in draft.order() {
        if let Some(at) = draft.branches[b].bearer {
            orders[b] = orders[at.branch] + 1;
        }
    }
    orders
}

fn mark(draft: &Draft, b: usize) -> Mark {
    let (branch, size) = (&draft.branches[b], draft.size());
    Mark {
        id: format!("{:016x}", branch.key),
        kind: branch.kind.into(),
        order: orders(draft)[b],
        base: branch.points.first().copied().unwrap_or(DVec3::ZERO) / size,
        direction: branch.direction(),
        length: branch.length() / size,
    }
}

fn find_like(draft: &Draft, mark: &Mark) -> Result<(usize, bool), Why> {
    let sound = mark.base.is_finite() && mark.direction.is_finite() && mark.length.is_finite();
    if !sound {
        return Err(Why::BadNumber { field: "mark" });
    }
    let (orders, size) = (orders(draft), draft.size());
    let id = u64::from_str_radix(&mark.id, 16).ok();
    let mut best: Option<(f64, usize, bool)> = None;
    for (i, b) in draft.branches.iter().enumerate() {
        if !b.alive || KindWord::from(b.kind) != mark.kind {
            continue;
        }
        let base = b.points.first().map_or(0.0, |p| (*p / size).distance(mark.base)) / FAR_BASE;
        let angle = base::ops::acos_clamped(b.direction().dot(mark.direction)) / FAR_ANGLE;
        let ratio = (b.length() / size).max(1e-9) / mark.length.max(1e-9);
        let length = base::ops::ln(ratio).abs() / FAR_LENGTH;
        let order = f64::from(orders[i].abs_diff(mark.order));
        let unlike = base.max(angle).max(length) + order;
        let same = id == Some(b.key);
        // The same key is strong evidence, but keys of strokes shift when a stroke is removed: the branch must still
        // look alike.
        let cost = if same { 0.3 * unlike } else { unlike };
        if cost < 1.0 && best.is_none_or(|(c, ..)| cost < c) {
            best = Some((cost, i, !same));
        }
    }
    best.map(|(_, i, likeness)| (i, likeness)).ok_or(Why::BranchGone)
}

fn find_path(draft: &Draft, path: &[u32]) -> Result<usize, Why> {
    let mut at = None;
    for &number in path {
        let shoots = draft.shoots_on(at);
        let next = shoots.get(number as usize).copied();
        at = Some(next.ok_or(Why::NoSuchNumber { number, there: shoots.len() })?);
    }
    at.ok_or(Why::EmptyPath)
}

fn find_near(draft: &Draft, p: DVec3) -> Result<usize, Why> {
    if !p.is_finite() {
        return Err(Why::BadNumber { field: "near" });
    }
    let limit = 0.1 * draft.size();
    let mut best = (limit, None);
    for (i, b) in draft.branches.iter().enumerate().filter(|(_, b)| b.alive && b.is_shoot()) {
        let (distance, _) = geom::nearest_on_polyline3(&b.points, p);
        if distance < best.0 {
            best = (distance, Some(i));
        }
    }
    best.1.ok_or(Why::NothingNear { within_m: limit })
}

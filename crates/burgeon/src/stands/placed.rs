//! Choice of the plant that stands for a tree, turned and scaled.

use base::{Draw, Report, Seed, ops, turn};
use forest::Tree;
use formats::Instance;
use glam::{DQuat, DVec3};

use super::variant::Variant;

/// Limits for scaling a plant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaleLimits {
    /// Least and largest scale along the height.
    pub tall: [f64; 2],
    /// Least and largest scale across over that along the height: beyond it leaves and branches look squeezed.
    pub wide: [f64; 2],
}

/// The limits in use: a tree of half or twice the height of a grown one has leaves of half or twice the size.
pub const LIMITS: ScaleLimits = ScaleLimits { tall: [0.4, 2.5], wide: [0.6, 1.7] };

/// Breast height, metres.
const BREAST_M: f64 = 1.3;
/// Cost of a wrong crown, relative to that of a wrong diameter.
const CROWN: f64 = 3.0;
/// Cost of a wrong height, relative to that of a wrong diameter.
const HEIGHT: f64 = 10.0;
/// Cost range of chance among plants that fit equally well.
const CHANCE: f64 = 0.02;
/// Share of the diameter by which a stem must be wrong to be reported.
const STEM_OFF: f64 = 0.25;
/// Least distance of a crown's middle from its foot, as a share of its width, that makes it one-sided.
const ONE_SIDED: f64 = 0.04;

/// A plant that stands for a tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed {
    /// Row of [`Nursery::variants`](super::Nursery::variants).
    pub variant: u32,
    /// Rotation of the plant.
    pub turn: DQuat,
    /// Scale along its own axes.
    pub scale: DVec3,
    /// Height of the plant minus that of the tree, metres.
    pub height_error_m: f64,
    /// Diameter at breast height of the plant minus that of the tree, metres; 0 for a tree without one.
    pub dbh_error_m: f64,
    /// Crown width of the plant minus that of the tree, metres.
    pub crown_error_m: f64,
    /// Whether a limit of scaling applied.
    pub is_clipped: bool,
}

impl Placed {
    /// Returns it as a copy whose tree is a row of a table.
    pub fn instance(&self, tree: &Tree, row: u32) -> Instance {
        Instance { at: tree.foot_m, turn: self.turn, scale: self.scale, tree: row }
    }
}

/// Returns the plant that fits a tree best: height before crown before diameter.
pub(super) fn place(variants: &[Variant], tree: &Tree, seed: Seed) -> Option<Placed> {
    let mut stream = seed.child(u64::from(tree.row)).stream(Draw::Scatter);
    let mut best: Option<(f64, Placed)> = None;
    for (row, variant) in (0..).zip(variants) {
        let (placed, cost) = fit(variant, tree);
        let cost = cost + CHANCE * stream.uniform();
        if best.is_none_or(|(least, _)| cost < least) {
            best = Some((cost, Placed { variant: row, ..placed }));
        }
    }
    best.map(|(_, placed)| placed)
}

fn fit(variant: &Variant, tree: &Tree) -> (Placed, f64) {
    let asked = [tree.height_m / variant.height_m, tree.crown_width_m / variant.crown_width_m];
    let tall = asked[0].clamp(LIMITS.tall[0], LIMITS.tall[1]);
    let wide = asked[1].clamp(LIMITS.wide[0] * tall, LIMITS.wide[1] * tall);
    let made = [tall * variant.height_m, wide * variant.crown_width_m];
    let dbh = if tree.dbh_m > 0.0 { variant.diameter_m(BREAST_M / tall) * wide } else { 0.0 };
    let off =
        |made: f64, asked: f64| if asked > 0.0 && made > 0.0 { ops::ln(made / asked).abs() } else { 0.0 };
    let missing = if tree.dbh_m > 0.0 && dbh <= 0.0 { 1.0 } else { off(dbh, tree.dbh_m) };
    let cost = missing + CROWN * off(made[1], tree.crown_width_m) + HEIGHT * off(made[0], tree.height_m);
    let placed = Placed {
        variant: 0,
        turn: turned(variant, tree),
        scale: DVec3::new(wide, tall, wide),
        height_error_m: made[0] - tree.height_m,
        dbh_error_m: dbh - tree.dbh_m,
        crown_error_m: made[1] - tree.crown_width_m,
        is_clipped: (tall - asked[0]).abs() > 0.0 || (wide - asked[1]).abs() > 0.0,
    };
    (placed, cost)
}

/// Returns the rotation: upright or leaning like the tree, with one-sided crowns of both on the same side.
fn turned(variant: &Variant, tree: &Tree) -> DQuat {
    let side = tree.crown_offset_m.with_y(0.0);
    let is_one_sided = side.length() > ONE_SIDED * tree.crown_width_m
        && variant.lean_m.length() > ONE_SIDED * variant.crown_width_m;
    // A turn about +Y by an angle takes +X to (cos, 0, -sin).
    let angle = |v: DVec3| ops::atan2(-v.z, v.x);
    let yaw = if is_one_sided { angle(side) - angle(variant.lean_m) } else { tree.yaw };
    turn::between(DVec3::Y, tree.up) * turn::about(DVec3::Y, yaw)
}

/// Differences between plants and the trees that they stand for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Misfits {
    /// Number of trees.
    pub trees: u64,
    /// Largest error of a height, metres, without its sign.
    pub height_error_max_m: f64,
    /// Largest error of a diameter at breast height, metres, without its sign.
    pub dbh_error_max_m: f64,
    /// Largest error of a crown width, metres, without its sign.
    pub crown_error_max_m: f64,
    /// The mean of the diameters' errors, metres, without their signs.
    pub dbh_error_mean_m: f64,
    /// Row in the inventory of the tree with the largest relative error of its height or crown.
    pub worst_row: u32,
    /// Trees whose plants the limits of scales changed.
    pub clipped: u64,
    /// Trees whose stems are more than a quarter too thick or too thin.
    pub stems_off: u64,
    sum_dbh: f64,
    worst: f64,
}

impl Misfits {
    /// Adds one more tree.
    pub fn add(&mut self, tree: &Tree, placed: &Placed) {
        self.trees += 1;
        self.height_error_max_m = self.height_error_max_m.max(placed.height_error_m.abs());
        self.dbh_error_max_m = self.dbh_error_max_m.max(placed.dbh_error_m.abs());
        self.crown_error_max_m = self.crown_error_max_m.max(placed.crown_error_m.abs());
        self.sum_dbh += placed.dbh_error_m.abs();
        self.dbh_error_mean_m = self.sum_dbh / self.trees as f64;
        self.clipped += u64::from(placed.is_clipped);
        self.stems_off += u64::from(placed.dbh_error_m.abs() > STEM_OFF * tree.dbh_m);
        let worst = (placed.height_error_m / tree.height_m).abs();
        let worst = worst.max((placed.crown_error_m / tree.crown_width_m).abs());
        if placed.is_clipped && worst > self.worst {
            (self.worst, self.worst_row) = (worst, tree.row);
        }
    }

    /// Warns where trees differ from the stand.
    pub fn tell(&self, report: &mut Report) {
        if self.stems_off > 0 {
            let (trees, all, most) = (self.stems_off, self.trees, self.dbh_error_max_m);
            base::warn!(
                report,
                "forest-stems-off",
                { trees = trees },
                "the stems of {trees} of {all} trees are more than a quarter too thick or too thin, up to {most:.2} m, as one plant \
                 stands for many trees: grow more variants"
            );
        }
        if self.clipped > 0 {
            let Self { clipped, worst_row, height_error_max_m, crown_error_max_m, .. } = *self;
            base::warn!(
                report,
                "forest-scale-clipped",
                { trees = clipped, row = worst_row },
                "{clipped} trees are too slender, too wide, too small or too large for their species, and were drawn only as far \
                 from it as looks right (height up to {height_error_max_m:.2} m off, crown up to {crown_error_max_m:.2} m; most in \
                 row {worst_row}): check their measures, or name a species of that habit"
            );
        }
    }
}

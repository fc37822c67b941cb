//! Applies edits to a plant and gives another plant: pure, the same bits everywhere.
//!
//! `Plant + edits -> Draft -> each edit done or not, with the reason -> Plant`

use base::{Counted, Run, Seed, Stopped};
use glam::{DQuat, DVec3};
use growth::Obstacles;
use plant::{OrganKind, Plant};

use crate::bench::{Bench, Stop};
use crate::draft::Draft;
use crate::edit::{Destination, HandEdit, Turn};
use crate::grow::KeptGrowth;
use crate::key::AxisKey;
use crate::outcome::{Changed, Outcome, Why};
use crate::pipes::Pipes;
use crate::seat::{Goal, Seat, goal, onto};
use crate::{fill, grow, leaves, sketch_branch, twin};

/// Facts that edits need in addition to the plant. They are not saved with the edits.
#[derive(Clone, Debug, Default)]
pub struct Context {
    /// Exponent of the pipe model that made the plant, 1.5 to 4; without it, the exponent is learnt from the plant's
    /// forks.
    pub pipe_exponent: Option<f64>,
    /// Obstacles that new branches grow around.
    pub obstacles: Obstacles,
}

/// An edited plant.
#[derive(Clone, Debug, PartialEq)]
pub struct Applied {
    /// The plant: `validate()` finds nothing wrong with it if it found nothing before.
    pub plant: Plant,
    /// Outcome of each edit, in their order.
    pub outcomes: Vec<Outcome>,
}

/// Applies edits one after another.
///
/// Guaranteed: the same plant for the same input on every platform and any thread count; an edit that cannot be done,
/// or does not pass [`HandEdit::check`], gives its reason and changes nothing; parts that an edit does not concern stay
/// bit for bit, except for the radii of the branches below it, which follow the pipe model; new branches keep out of
/// obstacles; a sound plant stays sound. Not guaranteed: that branches do not pass through one another. Cost: linear in
/// the plant for each edit, and in the new growth.
///
/// # Errors
/// [`Stopped`]: cancelled, or over the budget of the pieces that edits visit or that copies make.
///
/// ```
/// use base::Run;
/// use glam::DVec3;
/// use plant::{AxisKind, Plant};
/// use shape::{AxisKey, Context, HandEdit, apply};
/// let mut p = Plant::default();
/// let trunk = p.add_axis(AxisKind::Branch, None, 1, &[DVec3::ZERO, DVec3::Y, DVec3::Y * 2.0], None);
/// let fork = p.axis(trunk).node_ids().nth(1);
/// p.add_axis(AxisKind::Branch, fork, 2, &[DVec3::Y, DVec3::new(1.0, 1.5, 0.0)], None);
/// let cut = HandEdit::Prune { axis: AxisKey::Path(vec![0, 0]), at: 0.0 };
/// let again = [cut.clone(), cut];
/// let applied = apply(&p, &again, &Context::default(), &Run::plain())?;
/// assert_eq!((applied.plant.axes.len(), applied.outcomes[0].is_done()), (1, true));
/// assert_eq!(applied.outcomes[1].to_string(), "not done: there is no branch number 0 there: it has 0 (numbered from 0)");
/// # Ok::<(), base::Stopped>(())
/// ```
pub fn apply(
    plant: &Plant,
    edits: &[HandEdit],
    context: &Context,
    run: &Run<'_>,
) -> Result<Applied, Stopped> {
    if edits.is_empty() {
        return Ok(Applied { plant: plant.clone(), outcomes: Vec::new() });
    }
    let mut shaping = Shaping::new(plant);
    let outcomes = edits.iter().map(|e| shaping.push(e, context, run)).collect::<Result<_, _>>()?;
    Ok(Applied { plant: shaping.into_plant(), outcomes })
}

/// A plant while it is edited: edits may follow one another at any time.
///
/// Guaranteed: the same plant as from [`apply`] with all edits at once, bit for bit. So a caller that keeps a plant
/// with all edits but the last pays for the last only.
///
/// ```
/// use base::Run;
/// use glam::DVec3;
/// use plant::{AxisKind, Plant};
/// use shape::{AxisKey, Context, HandEdit, Shaping};
/// let mut p = Plant::default();
/// p.add_axis(AxisKind::Branch, None, 1, &[DVec3::ZERO, DVec3::Y, DVec3::Y * 2.0], None);
/// let mut shaping = Shaping::new(&p);
/// let cut = HandEdit::Prune { axis: AxisKey::Path(vec![0]), at: 0.5 };
/// assert!(shaping.push(&cut, &Context::default(), &Run::plain())?.is_done());
/// assert!(shaping.into_plant().nodes.position.iter().all(|p| p.y <= 1.0));
/// # Ok::<(), base::Stopped>(())
/// ```
#[derive(Clone, Debug)]
pub struct Shaping {
    draft: Draft,
    /// Number of pieces that the edits so far visited.
    gone_through: u64,
}

/// Advice for edits that take too long.
const FEWER_EDITS: &str = "take fewer edits, or edit a smaller plant";

impl Shaping {
    /// Starts to edit a plant. Cost: linear in the plant.
    pub fn new(plant: &Plant) -> Self {
        Self { draft: Draft::new(plant), gone_through: 0 }
    }

    /// Applies one edit, or gives the reason why not and changes nothing. Cost: linear in the plant and the new growth.
    ///
    /// # Errors
    /// [`Stopped`]: nothing was changed.
    pub fn push(&mut self, edit: &HandEdit, context: &Context, run: &Run<'_>) -> Result<Outcome, Stopped> {
        self.push_again(edit, context, &mut KeptGrowth::default(), run)
    }

    /// Repeats [`push`](Self::push) for a shoot that a hand holds: growth of the last call is reused. `kept`: for this
    /// plant and context, as the last call left it; it is empty after an edit by which nothing continues to grow.
    ///
    /// # Errors
    /// [`Stopped`]: nothing was changed.
    pub fn push_again(
        &mut self,
        edit: &HandEdit,
        context: &Context,
        kept: &mut KeptGrowth,
        run: &Run<'_>,
    ) -> Result<Outcome, Stopped> {
        run.cancel.check()?;
        let through = self.gone_through + self.draft.pieces();
        run.budget.check(Counted::EditedPieces, through, FEWER_EDITS)?;
        let bench = Bench { obstacles: &context.obstacles, exponent: context.pipe_exponent, run };
        let mut next = self.draft.clone();
        let before = leaf_count(&next);
        if !matches!(edit, HandEdit::Grow { .. }) {
            *kept = KeptGrowth::default();
        }
        let done = one(&mut next, edit, kept, &bench);
        self.gone_through = through;
        match done {
            Ok(mut changed) => {
                let after = leaf_count(&next);
                if changed.leaves_added == 0 {
                    changed.leaves_removed = before.saturating_sub(after);
                    changed.leaves_added = after.saturating_sub(before);
                } else {
                    changed.leaves_removed = (before + changed.leaves_added).saturating_sub(after);
                }
                next.branches.iter_mut().for_each(|b| b.fresh = false);
                self.draft = next;
                Ok(Outcome::Done(changed))
            }
            Err(Stop::Why(why)) => Ok(Outcome::NotDone(why)),
            Err(Stop::Stopped(stopped)) => Err(stopped),
        }
    }

    /// Returns the plant as it is now.
    pub fn into_plant(self) -> Plant {
        self.draft.into_plant()
    }
}

fn leaf_count(draft: &Draft) -> usize {
    draft.organs.iter().filter(|o| o.alive && o.what.kind == OrganKind::Leaf).count()
}

fn one(
    draft: &mut Draft,
    edit: &HandEdit,
    kept: &mut KeptGrowth,
    bench: &Bench<'_>,
) -> Result<Changed, Stop> {
    if !draft.branches.iter().any(|b| b.alive) {
        return Err(Why::NoBranches.into());
    }
    edit.check()?;
    let old = draft.branches.len();
    let mut changed = one_side(draft, edit, kept, bench)?;
    // An outline and its image are filled together.
    if let Some(mirror) = edit.mirror().filter(|_| !matches!(edit, HandEdit::Silhouette { .. })) {
        twin::complete(draft, mirror, old, &mut changed, bench)?;
    }
    Ok(changed)
}

/// Applies an edit without its mirror.
fn one_side(
    draft: &mut Draft,
    edit: &HandEdit,
    kept: &mut KeptGrowth,
    bench: &Bench<'_>,
) -> Result<Changed, Stop> {
    match edit {
        HandEdit::Rotate { axis, turn } => rotate(draft, axis, *turn),
        HandEdit::Move { axis, to, turn } => shift(draft, axis, to, *turn, bench),
        HandEdit::Copy { axis, to } => twin::copy(draft, axis, to, bench),
        HandEdit::Prune { axis, at } => prune(draft, axis, *at, bench),
        HandEdit::Regrow { axis, seed } => fill::regrow(draft, axis, Seed::new(*seed), bench),
        HandEdit::SketchBranch { bearer, at, points, twigs, seed, mirror: _ } => {
            let drawn = sketch_branch::Drawn { bearer, at: *at, points, twigs: *twigs };
            sketch_branch::add(draft, &drawn, Seed::new(*seed), bench)
        }
        HandEdit::Brush { bearer, points, radius_m, density, seed, mirror: _ } => {
            let stroke = sketch_branch::Stroke { points, radius_m, density: *density };
            sketch_branch::brush(draft, bearer.as_ref(), &stroke, Seed::new(*seed), bench)
        }
        HandEdit::Grow { from, towards, rounds, changes, seed, mirror: _ } => {
            let wish = grow::Wish { from, towards: *towards, rounds: *rounds, changes };
            grow::grow(draft, &wish, Seed::new(*seed), kept, bench)
        }
        HandEdit::Silhouette { plane, outline, density, trim, seed, mirror } => {
            let wanted = fill::Outline { plane, outline, density: *density, trim: *trim, mirror: *mirror };
            fill::silhouette(draft, &wanted, Seed::new(*seed), bench)
        }
        HandEdit::LeafDensity { region, keep, seed } => {
            leaves::density(draft, region, *keep, Seed::new(*seed), bench)
        }
    }
}

fn rotate(draft: &mut Draft, axis: &AxisKey, turn: Turn) -> Result<Changed, Stop> {
    let (b, by_likeness) = axis.find_in(draft)?;
    let quat = turn.quat()?;
    let what = draft.subtree(b);
    let base = draft.branches[b].points.first().copied().unwrap_or(DVec3::ZERO);
    draft.carry(&what, base, base, quat);
    Ok(Changed { moved: count(&what), by_likeness, ..Changed::default() })
}

fn count(what: &[bool]) -> usize {
    what.iter().filter(|w| **w).count()
}

fn shift(
    draft: &mut Draft,
    axis: &AxisKey,
    to: &Destination,
    then: Option<Turn>,
    bench: &Bench<'_>,
) -> Result<Changed, Stop> {
    let then = then.map(Turn::quat).transpose()?;
    let (b, by_likeness) = axis.find_in(draft)?;
    let base = draft.branches[b].points.first().copied().unwrap_or(DVec3::ZERO);
    let what = draft.subtree(b);
    let done = Changed { moved: count(&what), by_likeness, ..Changed::default() };
    let (host, share) = match goal(draft, b, to)? {
        Goal::Wood(host, share) => (host, share),
        Goal::Ground(by) => {
            draft.carry(&what, base, base + by, then.unwrap_or(DQuat::IDENTITY));
            return Ok(done);
        }
    };
    if what.get(host) == Some(&true) {
        return Err(Why::OntoItself.into());
    }
    let exponent = bench.habit(draft).exponent;
    let Seat { at: new, target, turn } = onto(draft, b, host, share);
    let old = draft.branches[b].bearer;
    draft.carry(&what, base, target, then.map_or(turn, |then| then * turn));
    draft.branches[b].bearer = Some(new);
    let radius = draft.branches[b].radii.first().copied().unwrap_or(0.0);
    let mut pipes = Pipes::default();
    pipes.book(old, radius, -1.0, exponent);
    pipes.book(Some(new), radius, 1.0, exponent);
    let tip = radius.min(draft.branches[host].radii.last().copied().unwrap_or(radius));
    pipes.settle(draft, exponent, tip);
    Ok(done)
}

fn prune(draft: &mut Draft, axis: &AxisKey, at: f64, bench: &Bench<'_>) -> Result<Changed, Stop> {
    if !at.is_finite() {
        return Err(Why::BadNumber { field: "at" }.into());
    }
    let (b, by_likeness) = axis.find_in(draft)?;
    let (bearer, radius) = (draft.branches[b].bearer, draft.branches[b].radii.first().copied());
    let habit = bench.habit(draft);
    let removed = draft.cut(b, at);
    if !draft.branches.iter().any(|b| b.alive) {
        return Err(Why::NothingLeft.into());
    }
    // A stump keeps its wood: a cut half-way along a branch changes nothing below.
    if !draft.branches[b].alive {
        let mut pipes = Pipes::default();
        pipes.book(bearer, radius.unwrap_or(0.0), -1.0, habit.exponent);
        pipes.settle(draft, habit.exponent, habit.tip_m);
    }
    Ok(Changed { removed, by_likeness, ..Changed::default() })
}

//! Copies of a plant in many places: along a line, in an area, under a brush.

use burgeon::document::{CommandError, DocumentPlant, Placement, PlantCommand, PlantId, SceneCommand};
use burgeon::geom;
use burgeon::glam::{DVec2, DVec3};
use burgeon::{Draw, Stream};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{Workspace, WorkspaceError};

/// Copies of a plant, and where they are to stand.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scatter {
    /// The plant.
    pub plant: PlantId,
    /// Where.
    pub ground: Ground,
    /// Least distance between any two plants, metres; 0.001 to 10,000.
    pub spacing_m: f64,
    /// How many different plants the copies are, each with a seed of its own; 0 for copies that are all alike.
    pub kinds: u32,
    /// How much sizes differ: copies are up to this share smaller or larger; 0 to 0.9.
    pub vary: f64,
}

/// Places on the ground: x and z, metres.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Ground {
    /// In a row along a line.
    Line(Vec<[f64; 2]>),
    /// All over a closed outline.
    Area(Vec<[f64; 2]>),
    /// All over what a brush covers.
    Brush {
        /// Its way.
        path: Vec<[f64; 2]>,
        /// Its radius, metres.
        radius_m: f64,
    },
}

/// So many darts in a row that miss mean that nothing is left to hit.
const MISSES: usize = 400;
/// As many places as a scene may have plants.
const MOST: usize = 200;

impl Workspace {
    /// Copies a plant to many places, as one step of undo. Places beside the plants that are there are left out, and so
    /// are those for which a scene has no room.
    ///
    /// # Errors
    /// [`WorkspaceError`]: that plant is not there, or no copy has room.
    pub(crate) fn scatter(&mut self, wanted: &Scatter) -> Result<(), WorkspaceError> {
        self.let_go();
        let document = self.editor.document();
        let plant = document.plant(wanted.plant).ok_or(WorkspaceError::PlantGone)?;
        let Placement { position, scale, .. } = plant.settings().placement;
        let seed = plant.settings().seed;
        let taken: Vec<DVec2> = document
            .plants()
            .iter()
            .map(|p| p.settings().placement.position)
            .map(|p| DVec2::new(p.x, p.z))
            .collect();
        // Another scattering of the same plant falls otherwise.
        let mut stream =
            seed.child(u64::from(wanted.plant.0)).child(taken.len() as u64).stream(Draw::Scatter);
        let spacing = if wanted.spacing_m.is_finite() { wanted.spacing_m.clamp(1e-3, 1e4) } else { 1.0 };
        let vary = if wanted.vary.is_finite() { wanted.vary.clamp(0.0, 0.9) } else { 0.0 };
        let places = places(&wanted.ground, spacing, &taken, &mut stream);
        if places.is_empty() {
            return Err(WorkspaceError::NowhereToStand);
        }
        self.editor.begin_gesture("scatter")?;
        for (k, at) in places.into_iter().enumerate() {
            let place = Placement {
                position: DVec3::new(at.x, position.y, at.y),
                yaw_deg: (stream.range(0.0, 3600.0)).round() / 10.0,
                scale: (scale * stream.range(1.0 - vary, 1.0 + vary) * 1000.0).round() / 1000.0,
            };
            let kind = stream.below(wanted.kinds.max(1) as usize) as u64;
            let own = (wanted.kinds > 0).then(|| seed.child(kind + 1));
            match self.copy_to(wanted.plant, place, own.map(PlantCommand::SetSeed)) {
                Ok(()) => {}
                // The scene is full: those before it stand.
                Err(CommandError::Full(_)) if k > 0 => break,
                Err(e) => {
                    self.editor.cancel_gesture();
                    return Err(e.into());
                }
            }
        }
        self.editor.commit();
        self.guest = None;
        Ok(())
    }

    fn copy_to(
        &mut self,
        plant: PlantId,
        place: Placement,
        seed: Option<PlantCommand>,
    ) -> Result<(), CommandError> {
        self.editor.run(SceneCommand::Duplicate(plant, DVec3::ZERO))?;
        let Some(copy) = self.editor.document().plants().last().map(DocumentPlant::id) else { return Ok(()) };
        for command in [Some(PlantCommand::Place(place)), seed].into_iter().flatten().map(|c| c.of(copy)) {
            match self.editor.run(command) {
                Ok(()) | Err(CommandError::Nothing(_)) => {}
                Err(e) => return Err(e),
            }
        }
        Ok(())
    }
}

/// Places with at least `spacing` between them and from those that are taken.
fn places(ground: &Ground, spacing: f64, taken: &[DVec2], stream: &mut Stream) -> Vec<DVec2> {
    let finite = |points: &[[f64; 2]]| -> Vec<DVec2> {
        points.iter().map(|&p| DVec2::from(p)).filter(|p| p.abs().max_element() <= 1e5).collect()
    };
    match ground {
        Ground::Line(line) => row(&finite(line), spacing, taken),
        Ground::Area(outline) => {
            let outline = finite(outline);
            darts(&outline, 0.0, spacing, taken, stream, |p| geom::contains(&outline, p))
        }
        Ground::Brush { path, radius_m } => {
            let (path, radius) =
                (finite(path), if radius_m.is_finite() { radius_m.clamp(0.0, 1e5) } else { 0.0 });
            let near = |p: DVec2| match path.as_slice() {
                [] => false,
                [only] => only.distance(p) <= radius,
                _ => path.windows(2).any(|w| to_segment(p, w[0], w[1]) <= radius),
            };
            darts(&path, radius, spacing, taken, stream, near)
        }
    }
}

fn to_segment(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let along = b - a;
    let share = (p - a).dot(along) / along.length_squared().max(f64::MIN_POSITIVE);
    p.distance(a + along * share.clamp(0.0, 1.0))
}

/// Every `spacing` metres along a line, from its start.
fn row(line: &[DVec2], spacing: f64, taken: &[DVec2]) -> Vec<DVec2> {
    let mut out: Vec<DVec2> = Vec::new();
    let mut next = 0.0;
    for w in line.windows(2) {
        let length = w[0].distance(w[1]);
        while next <= length && out.len() < MOST {
            let at = w[0].lerp(w[1], if length > 0.0 { next / length } else { 0.0 });
            // A thousandth less: the length of a way is not exact.
            if taken.iter().all(|t| t.distance(at) >= 0.999 * spacing) {
                out.push(at);
            }
            next += spacing;
        }
        next -= length;
    }
    out
}

/// Poisson-disc samples by darts (Cook 1986): each falls anywhere in the box and stays where it has room.
fn darts(
    around: &[DVec2],
    margin: f64,
    spacing: f64,
    taken: &[DVec2],
    stream: &mut Stream,
    within: impl Fn(DVec2) -> bool,
) -> Vec<DVec2> {
    let (low, high) = around.iter().fold((DVec2::MAX, DVec2::MIN), |(a, b), &p| (a.min(p), b.max(p)));
    let (low, high) = (low - margin, high + margin);
    let mut out: Vec<DVec2> = Vec::new();
    let mut misses = 0;
    while misses < MISSES && out.len() < MOST && low.cmple(high).all() {
        let at = DVec2::new(stream.range(low.x, high.x), stream.range(low.y, high.y));
        let free = within(at) && taken.iter().chain(&out).all(|t| t.distance(at) >= spacing);
        misses = if free { 0 } else { misses + 1 };
        if free {
            out.push(at);
        }
    }
    out
}

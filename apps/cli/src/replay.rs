//! `burgeon replay`: what hands did in a headset, done again without one.

use std::path::Path;

use burgeon::glam::DVec3;
use burgeon::mesh::{Material, MaterialId, MaterialKind, Model, Part, TriMesh};
use burgeon::render::{Picture, PictureSpec};
use serde::Serialize;
use workspace::{
    GestureDeed, GestureRecord, GestureStep, ShapeInput, ShapePointer, Workspace, WorkspaceError,
};

use crate::args::ReplayArgs;
use crate::failure::{Failure, Outcome};
use crate::machine::Machine;
use crate::output::Outputs;
use crate::{files, inputs, picture, project, report, say};

/// Between two pictures of a film, hundredths of a second.
const FRAME_CS: u16 = 12;
/// Nobody waits longer than this in a film, ms.
const LONGEST_WAIT_MS: u32 = 700;
/// Most pictures of a film: half a minute.
const MOST_FRAMES: usize = 250;
/// How long its end is looked at, hundredths of a second.
const END_CS: u16 = 200;
/// Side of a film that is given no size.
const FILM_SIDE: u32 = 360;

/// The report of this command.
#[derive(Debug, Serialize)]
struct Replay {
    schema: &'static str,
    command: &'static str,
    version: &'static str,
    record: String,
    steps: usize,
    /// Edits that gestures made.
    edits: usize,
    /// Of the plant that was worked on last.
    digest: Option<String>,
    /// The same as the record says; none where it says nothing.
    same: Option<bool>,
    /// Of the film.
    frames: usize,
}

pub(crate) fn replay(args: &ReplayArgs) -> Outcome {
    let machine = Machine::new(&args.common);
    let outputs = [
        ("--save", args.save.as_ref()),
        ("--png", args.png.as_ref()),
        ("--film", args.film.as_ref()),
        ("--report", args.common.report.as_ref()),
    ];
    let mut outputs = Outputs::new(&outputs, &[&args.record])?;
    args.given.check_picture(args.png.is_some() || args.film.is_some(), &args.picture)?;
    if let Some(png) = &args.png {
        picture::check_name(png)?;
    }
    if let Some(film) = &args.film
        && !files::extension(film).is_some_and(|e| e.eq_ignore_ascii_case("gif"))
    {
        return Err(Failure::at(film, "films are written as GIF; end the name with .gif"));
    }
    let path = args.record.as_path();
    let bytes = inputs::bytes(path).map_err(|e| Failure::io(path, "read", &e))?;
    let record = GestureRecord::read(&bytes).map_err(|e| Failure::at(path, e))?;
    let mut workspace = Workspace::default();
    let mut film = args.film.as_ref().map(|_| Film::default());
    let came = machine.with_progress("replay", |_| {
        workspace.replay(&record, &machine.run(), &mut |now, step| {
            if let Some(film) = &mut film {
                film.see(now, step);
            }
        })
    });
    let came = came.map_err(|e| match e {
        WorkspaceError::Cancelled => Failure::Cancelled,
        e => Failure::at(path, e),
    })?;
    if let Some(path) = &args.save {
        project::save(&mut outputs, "--save", path, workspace.document())?;
    }
    let seen = workspace.seen();
    let seed = 1;
    if let Some((path, model)) = args.png.as_ref().zip(seen.as_ref()) {
        let drawn = burgeon::render::render(model, &args.picture.spec(seed), &machine.run())?;
        picture::write(&mut outputs, "--png", path, &drawn)?;
    }
    let mut frames = 0;
    if let Some((path, film)) = args.film.as_ref().zip(film) {
        let mut spec = args.picture.spec(seed);
        if !args.given.has("size") {
            (spec.width, spec.height) = (FILM_SIDE, FILM_SIDE);
        }
        frames = film.write(path, seen, &spec, &mut outputs, &machine)?;
    }
    let same = record.digest.as_ref().map(|was| came.digest.as_ref() == Some(was));
    let told = Replay {
        schema: "burgeon.replay/1",
        command: "replay",
        version: burgeon::VERSION,
        record: path.display().to_string(),
        steps: record.steps.len(),
        edits: came.edits,
        digest: came.digest,
        same,
        frames,
    };
    report::finish(&told, &args.common, outputs)?;
    if !machine.quiet {
        if same == Some(false) {
            say::warning(&format!(
                "{}: the plant is another one than the record says; another version of Burgeon may have written it",
                path.display()
            ));
        }
        let edits = say::counted(told.edits as u64, "edit", "edits");
        let steps = say::counted(told.steps as u64, "step", "steps");
        say::line(&format!("{}: {steps}, {edits}; {}", path.display(), told.digest.unwrap_or_default()));
    }
    Ok(())
}

/// What is seen of a replay, one model a picture.
#[derive(Default)]
struct Film {
    frames: Vec<Model>,
    /// Of the film, and of the record, at the last step.
    now_ms: u32,
    was_ms: u32,
    hand: Option<ShapePointer>,
}

impl Film {
    fn see(&mut self, now: &Workspace, step: &GestureStep) {
        if let GestureDeed::Hand(hand) = &step.did {
            self.hand = match &hand.input {
                ShapeInput::Down(at) | ShapeInput::Up(at) => Some(*at),
                ShapeInput::Move(moves) => moves.last().copied().or(self.hand),
                _ => self.hand,
            };
        }
        self.now_ms += step.ms.saturating_sub(self.was_ms).min(LONGEST_WAIT_MS);
        self.was_ms = step.ms;
        let due = self.frames.len() as u64 * 10 * u64::from(FRAME_CS);
        if u64::from(self.now_ms) >= due
            && self.frames.len() < MOST_FRAMES
            && let Some(model) = now.seen()
        {
            self.frames.push(with_hand(model, self.hand));
        }
    }

    /// The number of its pictures.
    fn write(
        mut self,
        path: &Path,
        last: Option<Model>,
        spec: &PictureSpec,
        outputs: &mut Outputs,
        machine: &Machine,
    ) -> Outcome<usize> {
        self.frames.extend(last);
        if self.frames.is_empty() {
            return Err(Failure::at(path, "there is nothing to be seen in this record"));
        }
        let drawn =
            machine.with_progress("film", |_| burgeon::render::film(&self.frames, spec, &machine.run()))?;
        let bytes = gif_of(&drawn).map_err(|e| Failure::Bug(format!("the film cannot be written: {e}")))?;
        outputs.write("--film", path, |out| Ok(out.write_all(&bytes)?))?;
        Ok(drawn.len())
    }
}

/// A pointed thing where the hand is, pointing as it points.
fn with_hand(mut model: Model, hand: Option<ShapePointer>) -> Model {
    let Some(hand) = hand else { return model };
    let size = 0.035 * model.bounds().size().max_element();
    let tip = DVec3::from_array(hand.tip.unwrap_or(hand.origin));
    let along = DVec3::from_array(hand.direction).normalize_or(DVec3::NEG_Z);
    let (side, across) = along.any_orthonormal_pair();
    let mut mesh = TriMesh::default();
    let foot = tip - along * (3.0 * size);
    let around = [side, across, -side, -across].map(|way| mesh.push(foot + way * (0.6 * size)));
    let point = mesh.push(tip);
    for k in 0..4 {
        mesh.triangles.push([around[k], around[(k + 1) % 4], point]);
    }
    mesh.triangles.extend([[around[0], around[2], around[1]], [around[0], around[3], around[2]]]);
    mesh.compute_normals();
    let material = MaterialId::new(model.materials.len());
    let mut look = Material::plain("hand", MaterialKind::Other, [0.85, 0.35, 0.12]);
    look.double_sided = true;
    model.materials.push(look);
    model.parts.push(Part { name: "hand".into(), material, mesh });
    model
}

/// An animated picture that goes on for ever.
fn gif_of(pictures: &[Picture]) -> Result<Vec<u8>, gif::EncodingError> {
    let side = |n: u32| u16::try_from(n).unwrap_or(u16::MAX);
    let (width, height) = pictures.first().map_or((1, 1), |p| (side(p.width), side(p.height)));
    let mut bytes = Vec::new();
    let mut encoder = gif::Encoder::new(&mut bytes, width, height, &[])?;
    encoder.set_repeat(gif::Repeat::Infinite)?;
    for (k, picture) in pictures.iter().enumerate() {
        let mut pixels = picture.pixels.clone();
        let mut frame = gif::Frame::from_rgba_speed(width, height, &mut pixels, 10);
        frame.delay = if k + 1 == pictures.len() { END_CS } else { FRAME_CS };
        encoder.write_frame(&frame)?;
    }
    drop(encoder);
    Ok(bytes)
}

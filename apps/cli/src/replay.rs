//! `burgeon replay`: gestures recorded in a headset, replayed without one.

use std::collections::BTreeMap;
use std::path::Path;

use burgeon::glam::DVec3;
use burgeon::mesh::{Material, MaterialId, MaterialKind, Model, Part, TriMesh};
use burgeon::render::{Camera, Picture, PictureSpec, View};
use companions::LIMITS;
use serde::Serialize;
use workspace::{
    GestureDeed, GestureRecord, GestureStep, ShapeInput, ShapePointer, Workspace, WorkspaceError,
};

use crate::args::ReplayArgs;
use crate::failure::{Failure, Outcome};
use crate::machine::Machine;
use crate::output::Outputs;
use crate::{files, picture, project, report, say};

/// Time between two pictures of a film, hundredths of a second.
const FRAME_CS: u16 = 12;
/// Longest wait in a film, ms.
const LONGEST_WAIT_MS: u32 = 700;
/// Most pictures of a film: half a minute.
const MOST_FRAMES: usize = 250;
/// Time for which its last picture is shown, hundredths of a second.
const END_CS: u16 = 200;
/// Default side of a film, pixels.
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
    /// Digest of the plant that was worked on last.
    digest: Option<String>,
    /// Whether it equals that of the record; `None` where the record has none.
    same: Option<bool>,
    /// Number of pictures of the film.
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
        return Err(Failure::bad_file(film, "films are written as GIF; end the name with .gif"));
    }
    let path = args.record.as_path();
    let bytes = files::read_bytes(path, LIMITS.side_file)?;
    files::refuse_foreign(path, &bytes)?;
    let record = GestureRecord::read(&bytes).map_err(|e| Failure::bad_file(path, e))?;
    let mut workspace = Workspace::default();
    let mut film = args.film.as_ref().map(|_| (Film::default(), Extent::new()));
    let came = machine.with_progress("replay", |_| {
        workspace.replay(&record, &machine.run(), &mut |now, step| {
            if let Some((film, extent)) = &mut film
                && let Some(model) = film.see(now, step)
            {
                extent.add(&model);
            }
        })
    });
    let came = came.map_err(|e| failure_of(e, path))?;
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
    if let Some((path, (_, mut extent))) = args.film.as_ref().zip(film) {
        let last =
            seen.ok_or_else(|| Failure::bad_file(path, "there is nothing to be seen in this record"))?;
        extent.add(&last);
        let mut spec = args.picture.spec(seed);
        if !args.given.has("size") {
            (spec.width, spec.height) = (FILM_SIDE, FILM_SIDE);
        }
        if matches!(spec.view, View::Turntable { .. }) {
            spec.view = View::Front;
        }
        frames = draw(path, &record, (&extent, &last), &spec, &mut outputs, &machine)?;
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

/// Selection of the steps of a replay that are pictures of a film, and the pose of the hand.
#[derive(Default)]
struct Film {
    count: usize,
    /// Times of the film, and of the record, at the last step.
    now_ms: u32,
    was_ms: u32,
    hand: Option<ShapePointer>,
}

impl Film {
    /// Returns the model after a step, where a picture is due.
    fn see(&mut self, now: &Workspace, step: &GestureStep) -> Option<Model> {
        if let GestureDeed::Hand(hand) = &step.did {
            self.hand = match &hand.input {
                ShapeInput::Down(at) | ShapeInput::Up(at) => Some(*at),
                ShapeInput::Move(moves) => moves.last().copied().or(self.hand),
                _ => self.hand,
            };
        }
        self.now_ms += step.ms.saturating_sub(self.was_ms).min(LONGEST_WAIT_MS);
        self.was_ms = step.ms;
        let due = self.count as u64 * 10 * u64::from(FRAME_CS);
        if u64::from(self.now_ms) < due || self.count >= MOST_FRAMES {
            return None;
        }
        let model = now.seen()?;
        self.count += 1;
        Some(with_hand(model, self.hand))
    }
}

/// The outermost points of many models, which is all that a camera needs.
struct Extent {
    ways: Vec<DVec3>,
    furthest: Vec<(f64, DVec3)>,
}

impl Extent {
    fn new() -> Self {
        let five = || (-2..=2).map(f64::from);
        let ways = five().flat_map(|x| five().flat_map(move |y| five().map(move |z| DVec3::new(x, y, z))));
        let ways: Vec<DVec3> = ways.filter_map(DVec3::try_normalize).collect();
        Self { furthest: vec![(f64::NEG_INFINITY, DVec3::ZERO); ways.len()], ways }
    }

    fn add(&mut self, model: &Model) {
        let points = model.parts.iter().flat_map(|part| &part.mesh.positions);
        for p in points.map(|p| DVec3::from_array(p.map(f64::from))).filter(|p| p.is_finite()) {
            for (way, furthest) in self.ways.iter().zip(&mut self.furthest) {
                let out = way.dot(p);
                if out > furthest.0 {
                    *furthest = (out, p);
                }
            }
        }
    }

    fn points(&self) -> Vec<DVec3> {
        self.furthest.iter().filter(|f| f.0.is_finite()).map(|f| f.1).collect()
    }
}

/// Draws a film: replays the record once more, one picture at a time, with one camera that sees them all. Returns the
/// number of its pictures.
fn draw(
    path: &Path,
    record: &GestureRecord,
    (extent, last): (&Extent, &Model),
    spec: &PictureSpec,
    outputs: &mut Outputs,
    machine: &Machine,
) -> Outcome<usize> {
    let camera = Camera::framing(&extent.points(), spec);
    let shot = |model: &Model| burgeon::render::shot(model, spec, camera, &machine.run());
    let (mut film, mut strip) = (Film::default(), None::<Strip>);
    let mut went = Outcome::Ok(());
    let mut workspace = Workspace::default();
    let end = shot(last)?;
    machine
        .with_progress("film", |_| {
            workspace.replay(record, &machine.run(), &mut |now, step| {
                let Some(model) = film.see(now, step).filter(|_| went.is_ok()) else { return };
                went = shot(&model).map_err(Failure::from).and_then(|picture| {
                    let strip = match &mut strip {
                        Some(strip) => strip,
                        None => strip.insert(Strip::new(&[&picture, &end])?),
                    };
                    strip.add(picture)
                });
            })
        })
        .map_err(|e| failure_of(e, path))?;
    went?;
    let mut strip = match strip {
        Some(strip) => strip,
        None => Strip::new(&[&end])?,
    };
    strip.add(end)?;
    let bytes = strip.finish()?;
    outputs.write("--film", path, |out| Ok(out.write_all(&bytes)?))?;
    Ok(film.count + 1)
}

fn failure_of(e: WorkspaceError, path: &Path) -> Failure {
    match e {
        WorkspaceError::Cancelled => Failure::Cancelled,
        e => Failure::bad_file(path, e),
    }
}

/// Adds a pointed marker with the pose of the hand.
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

/// An animated picture that repeats without end, in one palette: of each picture, only the changes from the one before.
struct Strip {
    encoder: gif::Encoder<Vec<u8>>,
    size: (u16, u16),
    palette: Vec<[u8; 3]>,
    /// Number in the palette of the colour nearest to each one that occurred.
    nearest: BTreeMap<[u8; 3], u8>,
    /// The shown colours, and the frame that waits until its duration is known.
    shown: Vec<[u8; 3]>,
    waits: Option<gif::Frame<'static>>,
}

/// Number in the palette of pixels that are not drawn again: the last one.
const SAME: u8 = 255;
/// Largest difference of colours that count as equal: a moving hand changes all light a little.
const ALIKE: u8 = 5;

impl Strip {
    /// `samples`: pictures that have most of its colours, the first of them of its size.
    fn new(samples: &[&Picture]) -> Outcome<Self> {
        let side = |n: u32| u16::try_from(n).unwrap_or(u16::MAX);
        let size = samples.first().map_or((1, 1), |p| (side(p.width), side(p.height)));
        let pixels: Vec<u8> = samples.iter().flat_map(|p| &p.pixels).copied().collect();
        let learnt = color_quant::NeuQuant::new(3, SAME as usize, &pixels).color_map_rgb();
        let palette: Vec<[u8; 3]> = learnt.as_chunks().0.to_vec();
        let mut encoder =
            gif::Encoder::new(Vec::new(), size.0, size.1, &[&learnt[..], &[0; 3]].concat()).map_err(bug)?;
        encoder.set_repeat(gif::Repeat::Infinite).map_err(bug)?;
        Ok(Self { encoder, size, palette, nearest: BTreeMap::new(), shown: Vec::new(), waits: None })
    }

    fn number(&mut self, [r, g, b]: [u8; 3]) -> u8 {
        let Self { nearest, palette, .. } = self;
        *nearest.entry([r, g, b]).or_insert_with(|| {
            let away = |c: &[u8; 3]| {
                let d = |a: u8, b: u8| i32::from(a.abs_diff(b)).pow(2);
                // The eye is most sensitive to green, and least to blue.
                3 * d(c[0], r) + 6 * d(c[1], g) + d(c[2], b)
            };
            let numbered = (0..SAME).zip(palette.iter());
            numbered.min_by_key(|(_, c)| away(c)).map_or(0, |(k, _)| k)
        })
    }

    fn add(&mut self, picture: Picture) -> Outcome {
        let pixels = picture.pixels.as_chunks::<4>().0;
        let colours: Vec<[u8; 3]> = pixels.iter().map(|&[r, g, b, _]| [r, g, b]).collect();
        let (width, height) = (usize::from(self.size.0), usize::from(self.size.1));
        let alike = |a: &[u8; 3], b: &[u8; 3]| a.iter().zip(b).all(|(a, b)| a.abs_diff(*b) <= ALIKE);
        let is_same: Vec<bool> = match self.shown.is_empty() {
            true => vec![false; colours.len()],
            false => self.shown.iter().zip(&colours).map(|(a, b)| alike(a, b)).collect(),
        };
        let differs = |k: &usize| is_same.get(*k) == Some(&false);
        let columns = |k: usize| k % width.max(1);
        let changed = || (0..width * height).filter(differs);
        let Some((top, bottom)) = changed().next().zip(changed().next_back()) else {
            // Nothing moved: the last picture is shown longer.
            if let Some(frame) = &mut self.waits {
                frame.delay += FRAME_CS;
            }
            return Ok(());
        };
        let (top, bottom) = (top / width, bottom / width);
        let left = changed().map(columns).min().unwrap_or(0);
        let right = changed().map(columns).max().unwrap_or(0);
        let rows = (top..=bottom).flat_map(|y| (left..=right).map(move |x| y * width + x));
        let buffer: Vec<u8> =
            rows.map(|k| if differs(&k) { self.number(colours[k]) } else { SAME }).collect();
        let side = |n: usize| u16::try_from(n).unwrap_or(u16::MAX);
        let frame = gif::Frame {
            left: side(left),
            top: side(top),
            width: side(right + 1 - left),
            height: side(bottom + 1 - top),
            buffer: buffer.into(),
            transparent: Some(SAME),
            delay: FRAME_CS,
            dispose: gif::DisposalMethod::Keep,
            ..gif::Frame::default()
        };
        if self.shown.is_empty() {
            self.shown = colours;
        } else {
            let drawn = self.shown.iter_mut().zip(&colours).zip(&is_same).filter(|(_, same)| !**same);
            drawn.for_each(|((shown, colour), _)| *shown = *colour);
        }
        if let Some(before) = self.waits.replace(frame) {
            self.encoder.write_frame(&before).map_err(bug)?;
        }
        Ok(())
    }

    fn finish(mut self) -> Outcome<Vec<u8>> {
        if let Some(mut frame) = self.waits.take() {
            frame.delay = END_CS;
            self.encoder.write_frame(&frame).map_err(bug)?;
        }
        self.encoder.into_inner().map_err(|e| Failure::Bug(format!("the film cannot be written: {e}")))
    }
}

fn bug(e: gif::EncodingError) -> Failure {
    Failure::Bug(format!("the film cannot be written: {e}"))
}

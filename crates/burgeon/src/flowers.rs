//! Flowers that open -> a plant with its meshes, at any day.

use base::{Report, Run, Seed, Stopped};
use bloom::{FlowerSpec, GrowthLaw};
use document::PlantEdit;
use skin::{SkinSpec, SurfacePictures};

use crate::made::MadePlant;
use crate::report::ItemReport;
use crate::shaping::shaped;

/// Options of a flower in addition to its species and day.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FlowerOptions {
    /// Skin settings: `detail`, `wind`, `worn`. Its other colours are those of the species.
    pub skin: SkinSpec,
    /// Hand edits, applied to the plant in this order.
    pub edits: Vec<PlantEdit>,
}

/// Makes a whole flower at `day` (Huai, Yang and Cai 2019).
///
/// Guaranteed: the same vertices and triangles at every day, for edits that do not cut.
///
/// # Errors
/// [`Stopped`]; petals of more triangles than the budget allows are refused before any is made.
pub fn make_flower(
    name: &str,
    spec: &FlowerSpec,
    (day, law): (f64, &GrowthLaw),
    options: &FlowerOptions,
    seed: Seed,
    run: &Run<'_>,
) -> Result<MadePlant, Stopped> {
    let made = untold_flower(name, spec, (day, law), options, seed, run)?.with_digest();
    Ok(MadePlant { item: ItemReport { plant: Some(made.plant.measure()), ..made.item }, ..made })
}

/// Makes a flower as [`make_flower`] does, but without the digest and the measures of the plant, which take as long as
/// the meshes and are not seen.
pub(crate) fn untold_flower(
    name: &str,
    spec: &FlowerSpec,
    (day, law): (f64, &GrowthLaw),
    options: &FlowerOptions,
    seed: Seed,
    run: &Run<'_>,
) -> Result<MadePlant, Stopped> {
    spec.check(&run.budget)?;
    let mut report = Report::default();
    let mut plant = report.stage("structure", run.clock, |_| spec.make_on_day(day, law, seed));
    name.clone_into(&mut plant.name);
    let (plant, edits) = shaped(plant, &options.edits, run)?;
    run.cancel.check()?;
    debug_assert_eq!(plant.validate().next(), None, "a sound plant");
    let steady_m = Some(spec.size_m());
    let worn = options.skin.worn.clone().always(options.skin.textures);
    let skin = SkinSpec { textures: false, variation: 0.0, steady_m, worn, ..options.skin.clone() };
    let model = report.stage("mesh", run.clock, |_| {
        skin::skin_laid_out(&plant, &skin, SurfacePictures::default(), None, run)
    });
    Ok(MadePlant::untold(plant, (model?, skin), (edits, &options.edits), &report))
}

#[cfg(test)]
mod tests {
    use document::{Editor, FlowerCommand, FlowerMaker, Maker, NewPlant, SceneCommand, Settings};
    use glam::DVec3;

    use super::*;

    /// A report that is completed later equals one that is complete at once, and copies continue to share it.
    #[test]
    fn a_flower_is_seen_before_its_digest_is_told() {
        let mut editor = Editor::default();
        let settings =
            Settings { maker: Maker::Flower(Box::<FlowerMaker>::default()), ..Settings::default() };
        editor.run(SceneCommand::Add(Box::new(NewPlant { settings, strokes: vec![] }))).expect("sound");
        let first = editor.document().plants().last().expect("added").id();
        editor.run(SceneCommand::Duplicate(first, DVec3::X)).expect("sound");
        let copy = editor.document().plants().last().expect("copied").id();
        let (mut scene, mut whole) = (crate::SceneEvaluator::default(), crate::SceneEvaluator::default());
        scene.set_measuring_later(true);
        let run = Run::plain();
        for day in [1.0, 2.5] {
            editor.run(FlowerCommand::SetDay(day).for_plant(first)).expect("sound");
            editor.run(FlowerCommand::SetDay(day).for_plant(copy)).expect("sound");
            for id in [first, copy] {
                scene.update(id, editor.document(), &run).expect("sound");
                whole.update(id, editor.document(), &run).expect("sound");
                let seen = scene.get(id).expect("made").report();
                assert!(seen.digest.is_empty() && seen.plant.is_none(), "not yet");
            }
            assert!(scene.measure(first, &run).expect("not cancelled"), "something was left");
            for id in [first, copy] {
                assert!(!scene.measure(id, &run).expect("not cancelled"), "told for both");
                scene.update(id, editor.document(), &run).expect("sound");
                let (told, at_once) = (scene.get(id).expect("made"), whole.get(id).expect("made"));
                assert!(told.stages.is_empty(), "nothing is made again");
                assert_eq!(told.report().digest, at_once.report().digest);
                assert_eq!(told.report().plant, at_once.report().plant);
            }
            let number = |id| scene.get(id).expect("made").revision;
            assert_eq!(number(first), number(copy), "they share one model");
        }
    }

    #[test]
    fn a_flower_has_the_same_triangles_at_every_day() {
        for name in FlowerSpec::PRESETS {
            let spec = bloom::preset(name).unwrap();
            let law = spec.own_law();
            let options = FlowerOptions::default();
            let at =
                |day| make_flower(name, &spec, (day, &law), &options, Seed::new(1), &Run::plain()).unwrap();
            let first = at(0.0);
            let names: Vec<&str> = first.model.parts.iter().map(|p| p.name.as_str()).collect();
            assert!(names.contains(&"petals") && names.contains(&"stems"), "{names:?}");
            for k in 0..=8 {
                let day = (spec.opening_days + spec.wilting_days) * f64::from(k) / 8.0;
                let made = at(day);
                assert_eq!(made.plant.validate().next(), None, "{name} at {day}");
                assert_eq!(made.model.validate().next(), None, "{name} at {day}");
                let triangles =
                    |m: &mesh::Model| m.parts.iter().map(|p| p.mesh.triangles.clone()).collect::<Vec<_>>();
                assert!(triangles(&made.model) == triangles(&first.model), "{name} at {day}");
                assert_eq!(made.item.counts, first.item.counts, "{name} at {day}");
            }
        }
    }
}

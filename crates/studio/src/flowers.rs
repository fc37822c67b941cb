//! Flowers that open -> a plant with its meshes, at any day.

use base::{Report, Run, Seed, Stopped};
use bloom::{FlowerSpec, GrowthLaw};
use document::PlantEdit;
use skin::{SkinSpec, SurfacePictures};

use crate::made::MadePlant;
use crate::shaping::shaped;

/// What is asked of a flower beside its species and day.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FlowerOptions {
    /// How it is meshed: `detail`, `wind`, `worn`. Its other colours are those of the species.
    pub skin: SkinSpec,
    /// Edits by hand, done on the plant in this order.
    pub edits: Vec<PlantEdit>,
}

/// Makes a whole flower as it is at `day` (Huai, Yang and Cai 2019).
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
    spec.check(&run.budget)?;
    let mut report = Report::default();
    let mut plant = report.stage("structure", run.clock, |_| spec.at(day, law, seed));
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
    let mut made = MadePlant::new(plant, (model?, skin), (edits, &options.edits), &report);
    made.item.plant = Some(made.plant.measure());
    Ok(made)
}

#[cfg(test)]
mod tests {
    use super::*;

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

//! Light on the oak that comes with Burgeon: from meshes in memory to the light that each organ absorbs, on one thread.

use burgeon::light::{Beams, SkyKind};
use burgeon::{
    LightOptions, Preset, Report, Run, Seed, Stood, TreeEvaluator, TreeOptions, light_stand, mesh::Standing,
};
use divan::Bencher;

fn main() {
    divan::main();
}

/// By the number of times that light is followed from surface to surface.
#[divan::bench(args = [0, 3], sample_count = 3, sample_size = 1)]
fn oak(bencher: Bencher<'_, '_>, bounces: u32) {
    let spec = Preset::find("oak").expect("a preset").spec().expect("a spec");
    let mut tree = TreeEvaluator::default();
    tree.update(&spec, Seed::new(1), &TreeOptions::default(), &Run::plain()).expect("an oak");
    let stood = Stood {
        standing: Standing::home("oak", tree.model().expect("a model")),
        plant: tree.plant().expect("a plant"),
        layout: tree.layout().expect("a layout"),
    };
    let mut options = LightOptions::new(Beams::sky(SkyKind::Overcast, 100.0).expect("a sky"));
    options.spec.bounces = bounces;
    bencher.bench_local(|| {
        light_stand(&[stood], &options, (Seed::new(1), &Run::plain()), &mut Report::default()).expect("light")
    });
}

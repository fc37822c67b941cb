//! Large trees appear much coarser before they are whole, and no trace of that remains.

use burgeon::Run;
use burgeon::document::{PlantId, TreeCommand};
use workspace::{Action, Column, NewMaker, Workspace};

fn oak() -> Workspace {
    let mut workspace = Workspace::default();
    workspace
        .act(&Action::Add { name: "oak".into(), maker: NewMaker::Tree("oak".into()) })
        .expect("a preset");
    workspace
}

fn floats(workspace: &Workspace, id: PlantId, parts: usize) -> usize {
    (0..parts).map(|p| workspace.column(id, p, Column::Positions).len()).sum()
}

#[test]
fn a_tree_is_seen_coarse_first() {
    let (mut plain, mut workspace) = (oak(), oak());
    let whole = plain.evaluate(&Run::plain()).unwrap().plants.pop().unwrap();
    let saved = workspace.save().unwrap();
    let previews = workspace.preview_trees(&Run::plain()).unwrap();
    let [preview] = &previews[..] else { panic!("one tree") };
    assert!(
        preview.item.is_none()
            && preview.mesh.is_none()
            && preview.materials.iter().all(|m| m.texture.is_none())
    );
    let (coarse, fine) =
        (floats(&workspace, preview.id, preview.parts.len()), floats(&plain, whole.id, whole.parts.len()));
    assert!(4 * coarse < 3 * fine && 10 * coarse > fine, "{coarse} of {fine}");
    for k in 0..3 {
        let [size, other] = [whole.max[k] - whole.min[k], preview.max[k] - preview.min[k]];
        assert!((size - other).abs() < 0.15 * size, "of the same size: {other} m, not {size} m");
    }
    assert_eq!(workspace.save().unwrap(), saved);

    let made = workspace.evaluate(&Run::plain()).unwrap().plants.pop().unwrap();
    assert!(made.fresh);
    assert_eq!(made.stages, ["structure", "depth", "mesh"], "what the preview made counts");
    assert_eq!(
        made.item.as_ref().map(|i| (&i.digest, &i.counts)),
        whole.item.as_ref().map(|i| (&i.digest, &i.counts))
    );
    assert_eq!(floats(&workspace, made.id, made.parts.len()), fine);
    assert!(workspace.preview_trees(&Run::plain()).unwrap().is_empty(), "it is made");
}

#[test]
fn what_grows_nothing_needs_no_preview() {
    let mut workspace = oak();
    workspace.evaluate(&Run::plain()).unwrap();
    let id = workspace.current().unwrap();
    let skin = burgeon::skin::SkinSpec { detail: 0.5, ..Default::default() };
    workspace.run(TreeCommand::SetSkin(skin).for_plant(id)).unwrap();
    assert!(workspace.preview_trees(&Run::plain()).unwrap().is_empty());
    let first = workspace.evaluate(&Run::plain()).unwrap().plants.pop().unwrap();
    assert_eq!(first.stages, ["mesh"]);

    // A preview that is not followed by the whole leaves no trace either.
    workspace.act(&Action::Preset { plant: id, key: "maple".into() }).unwrap();
    assert_eq!(workspace.preview_trees(&Run::plain()).unwrap().len(), 1);
    workspace.undo();
    let back = workspace.evaluate(&Run::plain()).unwrap().plants.pop().unwrap();
    assert!(back.fresh, "the page shows the preview");
    assert_eq!(back.item.map(|i| i.digest), first.item.map(|i| i.digest));
}

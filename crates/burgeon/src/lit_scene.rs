//! Plants of a document in light.

use document::{CommandError, Document, DocumentPlant, Editor, Maker, PlantId, SketchCommand, TreeCommand};
use skin::SkinSpec;

use crate::scene::{SceneEvaluator, standing};
use scan::Stood;

/// Returns a document whose plants have no textures, which do not affect light. Numbers of plants stay.
///
/// # Errors
/// [`CommandError`].
pub fn without_textures(document: &Document) -> Result<Document, CommandError> {
    let mut editor = Editor::new(document.clone());
    let bare = |skin: &SkinSpec| skin.textures.then(|| SkinSpec { textures: false, ..skin.clone() });
    for plant in document.plants() {
        let id = plant.id();
        let command = match &plant.settings().maker {
            Maker::Sketch(s) => bare(&s.skin).map(|skin| SketchCommand::SetSkin(skin).for_plant(id)),
            Maker::Tree(t) => bare(&t.skin).map(|skin| TreeCommand::SetSkin(skin).for_plant(id)),
            _ => None,
        };
        command.map_or(Ok(()), |command| editor.run(command))?;
    }
    Ok(editor.document().clone())
}

/// Returns the plants of a document that were made, in their places; `None` if one of `ids` was not.
pub fn stood_plants<'a>(
    scene: &'a SceneEvaluator,
    document: &'a Document,
    ids: &[PlantId],
) -> Option<Vec<Stood<'a>>> {
    let stood = |id: &PlantId| {
        let (plant, made) = (document.plant(*id)?, scene.get(*id)?);
        Some(Stood { standing: standing(plant, made.model), plant: made.plant?, layout: made.owners? })
    };
    ids.iter().map(stood).collect()
}

/// Returns the plants of a document that are not hidden.
pub fn shown_plants(document: &Document) -> Vec<PlantId> {
    document.plants().iter().filter(|p| !p.settings().hidden).map(DocumentPlant::id).collect()
}

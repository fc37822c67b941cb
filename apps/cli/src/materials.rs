//! Files of materials for leaves, petals and sepals.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use burgeon::document::{
    Command, CommandError, Document, DocumentPlant, Editor, PlantCommand, PlantId, SketchCommand, WornPicture,
};
use burgeon::formats::{read_picture, write_png};
use burgeon::mesh::Texture;
use burgeon::skin::{OrganMaterial, Pattern, Wear, Wearer, Worn};

use companions::{LIMITS, Named};

use crate::failure::{Failure, Outcome};
use crate::{files, inputs};

/// Contents of a file of materials, with the pixels of its pictures by their paths.
#[derive(Debug, Default)]
pub(crate) struct Materials {
    wear: Wear,
    pictures: BTreeMap<String, Arc<Texture>>,
}

impl Materials {
    /// Reads a file of materials (.toml or .json) and the pictures next to it.
    pub(crate) fn read(path: &Path) -> Outcome<Self> {
        let wear: Wear = files::read_spec(path)?;
        let mut pictures = BTreeMap::new();
        for material in wear.materials() {
            let OrganMaterial { pattern, picture, .. } = material;
            match (pattern, picture) {
                (Pattern::Picture, Some(name)) if !pictures.contains_key(name) => {
                    pictures.insert(name.clone(), picture_beside(path, name)?);
                }
                (Pattern::Picture, Some(_)) => {}
                (Pattern::Picture, None) => {
                    let line = "has a material of the pattern picture without a picture; name one: picture = \"petal.png\"";
                    return Err(Failure::bad_file(path, line));
                }
                (_, Some(name)) => {
                    let line = format_args!(
                        "names the picture \"{name}\" in a material of the pattern {}; write pattern = \"picture\"",
                        pattern.word()
                    );
                    return Err(Failure::bad_file(path, line));
                }
                (_, None) => {}
            }
        }
        Ok(Self { wear, pictures })
    }

    /// Returns the materials in the form for meshing.
    pub(crate) fn worn(&self) -> Worn {
        self.wear.worn(|name| self.pictures.get(name).cloned())
    }

    /// Returns a document whose plant wears them instead of its own.
    pub(crate) fn on(&self, document: Document, id: PlantId) -> Outcome<Document> {
        let mut editor = Editor::new(document);
        let mut names = BTreeMap::new();
        for (name, texture) in &self.pictures {
            let mut png = Vec::new();
            write_png(texture.width, texture.height, &texture.pixels, &mut png)
                .map_err(|e| Failure::Bug(e.to_string()))?;
            let picture = WornPicture::new(png.into()).map_err(|e| Failure::Bad(format!("{name}: {e}")))?;
            names.insert(name.clone(), picture.name());
            run(&mut editor, PlantCommand::AddPicture(picture).for_plant(id))?;
        }
        let kept = |m: &OrganMaterial| {
            let picture = m.picture.as_ref().and_then(|name| names.get(name).cloned());
            OrganMaterial { picture, ..m.clone() }
        };
        let ids: Vec<_> = editor
            .document()
            .plant(id)
            .map_or(&[][..], DocumentPlant::strokes)
            .iter()
            .map(|s| s.id)
            .collect();
        if !ids.is_empty() {
            run(&mut editor, SketchCommand::SetMaterial(ids.clone(), None).for_plant(id))?;
        }
        // Unused pictures are dropped, so strokes put them on first.
        for wear in &self.wear.strokes {
            let strokes = wear.strokes.iter().filter_map(|&row| ids.get(row as usize).copied()).collect();
            run(&mut editor, SketchCommand::SetMaterial(strokes, Some(kept(&wear.material))).for_plant(id))?;
        }
        for wearer in Wearer::ALL {
            run(&mut editor, PlantCommand::Wear(wearer, self.wear.material(wearer).map(kept)).for_plant(id))?;
        }
        Ok(editor.document().clone())
    }
}

/// Runs a command whose setting may already apply.
fn run(editor: &mut Editor, command: Command) -> Outcome {
    match editor.run(command) {
        Ok(()) | Err(CommandError::Nothing(_)) => Ok(()),
        Err(e) => Err(Failure::Bad(e.to_string())),
    }
}

fn picture_beside(path: &Path, name: &str) -> Outcome<Arc<Texture>> {
    let bytes = inputs::named_bytes(path, name, LIMITS.picture)?;
    let line = "is no PNG or JPEG picture that can be read";
    let picture = read_picture(&bytes).map(Arc::new);
    picture.ok_or_else(|| Failure::bad_file(&Named { naming: path, name }.path(), line))
}

//! Copies of a plant in many places, as one step of undo.

use burgeon::Draw;
use burgeon::document::{CommandError, DocumentPlant, Placement, PlantCommand, PlantId, SceneCommand};
use burgeon::glam::{DVec2, DVec3};

use crate::scatter::{places, turned};
use crate::{Scatter, Workspace, WorkspaceError};

impl Workspace {
    /// Copies a plant to many places, as one step of undo. Places too near to existing plants are left out, and so are
    /// those for which a scene has no room.
    ///
    /// # Errors
    /// [`WorkspaceError`]: the plant does not exist, or no copy has room.
    pub(crate) fn scatter(&mut self, wanted: &Scatter) -> Result<(), WorkspaceError> {
        self.let_go();
        let document = self.editor.document();
        let plant = document.plant(wanted.plant).ok_or(WorkspaceError::PlantGone)?;
        let own = plant.settings();
        let (Placement { position, scale, .. }, seed) = (own.placement, own.seed);
        // Copies form one group with their plant.
        let group = if own.group.is_empty() { own.name.clone() } else { own.group.clone() };
        let taken: Vec<DVec2> = document
            .plants()
            .iter()
            .map(|p| p.settings().placement.position)
            .map(|p| DVec2::new(p.x, p.z))
            .collect();
        // Another scattering of the same plant gives other places.
        let mut stream =
            seed.child(u64::from(wanted.plant.0)).child(taken.len() as u64).stream(Draw::Scatter);
        let spacing = if wanted.spacing_m.is_finite() { wanted.spacing_m.clamp(1e-3, 1e4) } else { 1.0 };
        let vary = if wanted.vary.is_finite() { wanted.vary.clamp(0.0, 0.9) } else { 0.0 };
        let places = places(&wanted.ground, spacing, &taken, &mut stream);
        if places.is_empty() {
            return Err(WorkspaceError::NowhereToStand);
        }
        self.editor.begin_gesture("scatter")?;
        if let Err(e) = self.set(PlantCommand::Group(group), wanted.plant) {
            self.editor.cancel_gesture();
            return Err(e.into());
        }
        for (k, at) in places.into_iter().enumerate() {
            let place = turned(at, position.y, scale, vary, &mut stream);
            let kind = stream.below(wanted.kinds.max(1) as usize) as u64;
            let own = (wanted.kinds > 0).then(|| seed.child(kind + 1));
            match self.copy_to(wanted.plant, place, own.map(PlantCommand::SetSeed)) {
                Ok(()) => {}
                // The scene is full: earlier copies stay.
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
        [Some(PlantCommand::Place(place)), seed].into_iter().flatten().try_for_each(|c| self.set(c, copy))
    }

    /// Runs a command whose setting the plant may already have.
    fn set(&mut self, command: PlantCommand, plant: PlantId) -> Result<(), CommandError> {
        match self.editor.run(command.for_plant(plant)) {
            Err(CommandError::Nothing(_)) => Ok(()),
            done => done,
        }
    }
}

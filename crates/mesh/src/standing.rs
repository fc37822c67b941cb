//! Models in their places, and the one model that they make together.

use glam::{DQuat, DVec3};

use crate::copies::{Copies, CopyPlace};
use crate::material::MaterialId;
use crate::trimesh::Model;

/// A model with a place in a scene: scaled, rotated, then moved. Several may refer to the same model: copies.
#[derive(Clone, Copy, Debug)]
pub struct Standing<'a> {
    /// Its name in the scene.
    pub name: &'a str,
    /// The model.
    pub model: &'a Model,
    /// Position of its origin, metres.
    pub position: DVec3,
    /// Its rotation.
    pub turn: DQuat,
    /// Its scale factor.
    pub scale: f64,
}

impl<'a> Standing<'a> {
    /// Returns a model at the place where it was made.
    pub fn home(name: &'a str, model: &'a Model) -> Self {
        Self { name, model, position: DVec3::ZERO, turn: DQuat::IDENTITY, scale: 1.0 }
    }

    /// Returns whether the model is at the place where it was made.
    pub fn is_home(&self) -> bool {
        self.position == DVec3::ZERO
            && self.turn == DQuat::IDENTITY
            && self.scale.to_bits() == 1.0_f64.to_bits()
    }
}

/// Joins the models of a scene into one, each in its place. Parts carry the name of their plant where there are
/// several.
///
/// Guaranteed: for one plant that stands at the origin, the model itself, bit for bit.
pub fn scene_model(name: &str, plants: &[Standing<'_>]) -> Model {
    if let [only] = plants
        && only.is_home()
    {
        return Model { name: name.into(), ..only.model.clone() };
    }
    let mut whole = Model { name: name.into(), ..Model::default() };
    for (k, plant) in plants.iter().enumerate() {
        let first = whole.materials.len();
        let own = |what: &str| {
            if plants.len() > 1 { format!("{}-{}-{what}", k + 1, plant.name) } else { what.to_owned() }
        };
        whole.materials.extend(plant.model.materials.iter().map(|m| {
            let mut m = m.clone();
            m.name = own(&m.name);
            m
        }));
        for part in &plant.model.parts {
            let mut part = part.clone();
            for p in part.mesh.positions.iter_mut().chain(&mut part.mesh.pivots) {
                let at = plant.turn * (DVec3::from_array(p.map(f64::from)) * plant.scale) + plant.position;
                *p = at.as_vec3().to_array();
            }
            for n in &mut part.mesh.normals {
                *n = (plant.turn * DVec3::from_array(n.map(f64::from))).as_vec3().to_array();
            }
            part.name = own(&part.name);
            part.material = MaterialId::new(first + part.material.index());
            whole.parts.push(part);
        }
    }
    whole
}

/// Returns the leaves of plants in their places, as [`scene_model`] joins what is left of the plants. `copies`: those
/// of each plant.
pub fn scene_copies(plants: &[Standing<'_>], copies: &[&[Copies]]) -> Vec<Copies> {
    let (mut all, mut first) = (Vec::new(), 0);
    for (k, (plant, copies)) in plants.iter().zip(copies).enumerate() {
        for copy in *copies {
            let name = if plants.len() > 1 {
                format!("{}-{}-{}", k + 1, plant.name, copy.name)
            } else {
                copy.name.clone()
            };
            let places = copy.places.iter().map(|p| CopyPlace {
                at: plant.turn * (p.at * plant.scale) + plant.position,
                turn: plant.turn * p.turn,
                scale: plant.scale * p.scale,
                color: p.color,
            });
            let material = MaterialId::new(first + copy.material.index());
            all.push(Copies { name, material, mesh: copy.mesh.clone(), places: places.collect() });
        }
        first += plant.model.materials.len();
    }
    all
}

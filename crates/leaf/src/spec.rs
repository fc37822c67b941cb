//! Settings of a measured leaf.

use geom::RingRule;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::balls::{self, BallMove};
use crate::form::LeafForm;
use crate::marks::{FullMarks, MarksError};
use crate::pose::Pose;
use crate::rays::{Rays, RaysError};
use crate::thickness::ThicknessRule;

/// Surface of a measured blade (Wang et al. 2011, section 2.2).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SurfaceKind {
    /// One smooth polynomial of the marks as controls, far from the marks.
    Bezier,
    /// A B-spline near the marks.
    Approximate,
    /// A B-spline through all marks, with the folds of the blade.
    #[default]
    Interpolate,
    /// As approximate, drawn towards thick veins.
    Nurbs,
}

// The choices are in the order of Wang et al. (2011).
base::words!(SurfaceKind {
    Bezier = "bezier",
    Approximate = "approximate",
    Interpolate = "interpolate",
    Nurbs = "nurbs",
});

/// Parameters of an interpolating side vein.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum VeinParameters {
    /// Those of the blade, so that the vein lies on it.
    #[default]
    Shared,
    /// The chord lengths of its own marks, as published: vein and blade meet at the marks only.
    Own,
}

/// Colouring of a measured blade.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LeafPaint {
    /// Painted by the distance from the veins.
    #[default]
    Veins,
    /// One green.
    Plain,
}

/// Construction of a leaf from its marks (Wang et al. 2011). Saved with the document; commands and panels set its
/// fields.
///
/// ```
/// let spec: leaf::LeafSpec = spec::from_toml("surface = \"nurbs\"\ncurl = 0.5").expect("a spec");
/// assert_eq!((spec.surface, spec.sides), (leaf::SurfaceKind::Nurbs, 10));
/// assert!(spec::from_toml::<leaf::LeafSpec>("curl = 3.0").is_err());
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct LeafSpec {
    /// Surface of the blade.
    pub surface: SurfaceKind,
    /// Roll about the midrib: -1 (margins meet below) to 1 (above), 0 as measured, default 0.
    #[schemars(range(min = -1.0, max = 1.0))]
    pub curl: f64,
    /// Loss of stiffness: 0 as measured to 1 hanging limp, default 0.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub wilt: f64,
    /// Control balls moved and rescaled by hand (Wang et al. 2011, Fig 4), one after another; default none.
    pub balls: Vec<BallMove>,
    /// Colour of the blade.
    pub texture: LeafPaint,
    /// Meaning of a measured thickness; default that of the file, otherwise the diameter.
    pub thickness: Option<ThicknessRule>,
    /// Parameters of interpolating side veins.
    pub parameters: VeinParameters,
    /// Pull of the thickest vein on a NURBS blade, 1 (none) to 100, default 4.
    #[schemars(range(min = 1.0, max = 100.0))]
    pub vein_weight: f64,
    /// Rings of the veins.
    pub rings: RingRule,
    /// Parts of each span between marks, 1 to 64, default 5.
    #[schemars(range(min = 1, max = 64))]
    pub subdivisions: u32,
    /// Points around a vein, 3 to 64, default 10.
    #[schemars(range(min = 3, max = 64))]
    pub sides: u32,
    /// Round ends on the veins; default false.
    pub caps: bool,
    /// A vein along the margin too; default false.
    pub margin_vein: bool,
    /// Form of the leaf if nothing was measured.
    pub form: LeafForm,
    /// Length of the midrib for a vein graph in pixels, metres, 0.002 to 10, default 0.1.
    #[schemars(range(min = 0.002, max = 10.0), extend("x-unit" = "m"))]
    pub length_m: f64,
}

spec::schemas!(LeafSpec = include_str!("../schemas/leaf.json"));
spec::schemas!(LeafForm => LeafSpec, "/$defs/LeafForm");

impl Default for LeafSpec {
    fn default() -> Self {
        Self {
            surface: SurfaceKind::default(),
            curl: 0.0,
            wilt: 0.0,
            balls: Vec::new(),
            texture: LeafPaint::default(),
            thickness: None,
            parameters: VeinParameters::default(),
            // 4: the blade visibly follows the midrib, and folds next to it stay soft.
            vein_weight: 4.0,
            rings: RingRule::default(),
            // As in Table 1 of Wang et al. (2011).
            subdivisions: 5,
            sides: 10,
            caps: false,
            margin_vein: false,
            form: LeafForm::default(),
            length_m: 0.1,
        }
    }
}

impl LeafSpec {
    /// Returns the marks with balls moved by hand, then curl and wilt. The margin follows.
    ///
    /// # Errors
    /// [`MarksError::NoBall`] for a ball that the leaf does not have; those of
    /// [`Marks::validate`](crate::Marks::validate) for the moved marks.
    pub fn shaped(&self, marks: &FullMarks) -> Result<FullMarks, MarksError> {
        Ok(self.pose().apply(&self.moved(marks)?))
    }

    /// As [`shaped`](Self::shaped), without curl and wilt.
    ///
    /// # Errors
    /// As there.
    pub fn moved(&self, marks: &FullMarks) -> Result<FullMarks, MarksError> {
        balls::moved(&self.balls, marks)
    }

    /// As [`shaped`](Self::shaped), for chief veins that start together. A ball at the base, which all veins share, is
    /// moved on all of them.
    ///
    /// # Errors
    /// [`RaysError::NoBall`] for a ball that the leaf does not have.
    pub fn shaped_rays(&self, rays: &Rays) -> Result<Rays, RaysError> {
        Ok(self.pose().apply_rays(&balls::moved_rays(&self.balls, rays)?))
    }

    /// Returns its curl and wilt, hanging down if it is limp.
    pub fn pose(&self) -> Pose {
        Pose { curl: self.curl, wilt: self.wilt, ..Pose::default() }
    }
}

//! Stress below the surface: what is asked for, and the answer.

mod places;

pub use places::{Direction, Places, Steps, SubsurfaceLine, SubsurfacePlane, SubsurfaceSurface};

use stickslip_mechanics as mechanics;
use stickslip_mechanics::subsurface::Side;

use crate::definition::{Body, of_body};
use crate::document::checked_alone;
use crate::limits::SUBSURFACE_POINTS;
use crate::prelude::*;

requests! {
/// The stress in one of the bodies, tension positive: x along the motion of the first body, which carries the profile,
/// z into the body asked for, the origin on the axis of the contact. Exactly one of `points`, `line`, `plane` and
/// `surface` says where.
#[schema(example = json!({
    "body": "first", "plane": {"normal": "y", "offset": 0.0, "x": [-2e-4, 2e-4, 41], "z": [0.0, 2e-4, 21]},
    "fields": ["von_mises"]
}))]
pub struct SubsurfaceRequest {
    /// The body whose stress is asked for.
    pub body: BodyName,
    /// Poisson's ratio of the body, a pure number; it may be left out if the material has `bodies`.
    pub poisson_ratio: Option<f64> = range::POISSON_RATIO,
    /// A list of x, y, z, m, with z not negative.
    pub points: Option<Vec<[f64; 3]>> = Array(SUBSURFACE_POINTS, range::PLACE),
    /// A straight line.
    pub line: Option<SubsurfaceLine>,
    /// A grid in a plane.
    pub plane: Option<SubsurfacePlane>,
    /// A grid on the surface.
    pub surface: Option<SubsurfaceSurface>,
    /// Which fields are computed; if left out, `tensor`.
    pub fields: Option<Vec<SubsurfaceField>>,
    /// A uniform stress of the body that is added, Pa. In this model it does not shift the stick zone.
    pub bulk: Option<Bulk>,
}

/// A uniform stress, Pa, tension positive; a component left out is zero.
pub struct Bulk: Copy, Default {
    /// Normal stress along x.
    pub xx: Option<f64> = range::BULK_STRESS,
    /// Normal stress along y.
    pub yy: Option<f64> = range::BULK_STRESS,
    /// Normal stress along z.
    pub zz: Option<f64> = range::BULK_STRESS,
    /// Shear stress in the plane of x and y.
    pub xy: Option<f64> = range::BULK_STRESS,
    /// Shear stress in the plane of y and z.
    pub yz: Option<f64> = range::BULK_STRESS,
    /// Shear stress in the plane of x and z.
    pub xz: Option<f64> = range::BULK_STRESS,
}
}

words! {
/// A quantity below the surface.
pub enum SubsurfaceField {
    /// The six components `xx`, `yy`, `zz`, `xy`, `yz`, `xz`, Pa.
    Tensor = "tensor",
    /// The principal stresses `principal_1` to `principal_3`, in decreasing order, Pa.
    Principal = "principal",
    /// Von Mises's equivalent stress `von_mises`, Pa.
    VonMises = "von_mises",
    /// The largest shear stress `max_shear` on any plane, Pa.
    MaxShear = "max_shear",
    /// The mean normal stress `hydrostatic`, Pa.
    Hydrostatic = "hydrostatic",
}
}

replies! {
/// Stresses below the surface, in columns; an array that was not asked for is left out, and an infinite stress is
/// `null`.
pub struct Subsurface: Default omits Option {
    /// Place along the motion of the first body, m.
    pub x: Vec<f64>,
    /// Place across the motion of the first body, m.
    pub y: Vec<f64>,
    /// Depth into the body, m; never negative.
    pub z: Vec<f64>,
    /// Normal stress along x, Pa; tension is positive.
    pub xx: Option<Vec<Option<f64>>>,
    /// Normal stress along y, Pa; tension is positive.
    pub yy: Option<Vec<Option<f64>>>,
    /// Normal stress along z, Pa; tension is positive.
    pub zz: Option<Vec<Option<f64>>>,
    /// Shear stress in the plane of x and y, Pa.
    pub xy: Option<Vec<Option<f64>>>,
    /// Shear stress in the plane of y and z, Pa.
    pub yz: Option<Vec<Option<f64>>>,
    /// Shear stress in the plane of x and z, Pa.
    pub xz: Option<Vec<Option<f64>>>,
    /// Largest principal stress, Pa; tension is positive.
    pub principal_1: Option<Vec<Option<f64>>>,
    /// Middle principal stress, Pa; tension is positive.
    pub principal_2: Option<Vec<Option<f64>>>,
    /// Smallest principal stress, Pa; tension is positive.
    pub principal_3: Option<Vec<Option<f64>>>,
    /// Von Mises's equivalent stress, Pa; never negative.
    pub von_mises: Option<Vec<Option<f64>>>,
    /// Largest shear stress on any plane, Pa; never negative.
    pub max_shear: Option<Vec<Option<f64>>>,
    /// Mean normal stress, Pa; tension is positive.
    pub hydrostatic: Option<Vec<Option<f64>>>,
}

/// Stresses below the surface of a contact on the server.
pub struct SubsurfaceReply {
    /// The columns.
    #[serde(flatten)]
    pub stress: Subsurface,
    /// Solver, errors and time.
    pub accuracy: Accuracy,
    /// Warnings about the result.
    pub warnings: Vec<Warning>,
}
}

impl Subsurface {
    /// The columns of values, all in Pa, with their names; only those that are asked for have values.
    pub fn columns(&self) -> [(&'static str, Option<&[Option<f64>]>); 12] {
        [
            ("xx", self.xx.as_deref()),
            ("yy", self.yy.as_deref()),
            ("zz", self.zz.as_deref()),
            ("xy", self.xy.as_deref()),
            ("yz", self.yz.as_deref()),
            ("xz", self.xz.as_deref()),
            ("principal_1", self.principal_1.as_deref()),
            ("principal_2", self.principal_2.as_deref()),
            ("principal_3", self.principal_3.as_deref()),
            ("von_mises", self.von_mises.as_deref()),
            ("max_shear", self.max_shear.as_deref()),
            ("hydrostatic", self.hydrostatic.as_deref()),
        ]
    }
}

impl AsRef<Subsurface> for Subsurface {
    fn as_ref(&self) -> &Subsurface {
        self
    }
}

impl AsRef<Subsurface> for SubsurfaceReply {
    fn as_ref(&self) -> &Subsurface {
        &self.stress
    }
}

/// A checked request.
#[derive(Clone, Debug)]
pub struct SubsurfaceTask {
    /// Which body.
    pub side: Side,
    /// Its Poisson's ratio.
    pub poisson_ratio: f64,
    /// Where.
    pub places: Places,
    /// Which fields.
    pub fields: Vec<SubsurfaceField>,
    /// What is added, Pa.
    pub bulk: Option<mechanics::Stress>,
}

impl SubsurfaceTask {
    /// Whether it is for one quantity over a grid in a plane, which can be drawn.
    pub fn is_section(&self) -> bool {
        let single = |field: &SubsurfaceField| !matches!(field, SubsurfaceField::Tensor | SubsurfaceField::Principal);
        matches!(&self.fields[..], [only] if single(only)) && matches!(self.places, Places::Grid(_))
    }

    /// The name of the body.
    pub fn body_name(&self) -> &'static str {
        BodyName::from(self.side).name()
    }

    /// How many columns its reply has.
    pub fn columns(&self) -> usize {
        let of = |field, columns| if self.wants(field) { columns } else { 0 };
        let single = [SubsurfaceField::VonMises, SubsurfaceField::MaxShear, SubsurfaceField::Hydrostatic];
        let all = [3, of(SubsurfaceField::Tensor, 6), of(SubsurfaceField::Principal, 3)];
        all.into_iter().chain(single.into_iter().map(|field| of(field, 1))).sum()
    }

    /// Whether a field is asked for.
    pub fn wants(&self, field: SubsurfaceField) -> bool {
        self.fields.contains(&field)
    }
}

// What can only be checked against a contact is checked by [`SubsurfaceRequest::of_contact`].
checked_alone!(SubsurfaceRequest);

impl SubsurfaceRequest {
    /// The checked request for a contact of this definition.
    ///
    /// # Errors
    /// [`Rejection::Invalid`] with every fault.
    pub fn of_contact(self, contact: &ContactDefinition) -> Result<SubsurfaceTask, Rejection> {
        let mut faults = Faults::default();
        self.check_limits(JsonPath::Root, &mut faults);
        let task = self.at(contact, JsonPath::Root, &mut faults);
        faults.done(task)
    }

    /// The checked request for a contact of this definition; its faults beside the limits of its members are noted at
    /// `at`.
    pub fn at(self, contact: &ContactDefinition, at: JsonPath<'_>, faults: &mut Faults) -> Option<SubsurfaceTask> {
        let poisson_ratio = poisson_ratio(self.body, self.poisson_ratio, contact, at, faults);
        let fields = self.fields.unwrap_or_else(|| vec![SubsurfaceField::Tensor]);
        if fields.is_empty() {
            let names = "name at least one of `tensor`, `principal`, `von_mises`, `max_shear`, `hydrostatic`";
            faults.add(at.member("fields"), format_args!("empty: {names}"));
        }
        let bulk = self.bulk.map(|bulk| bulk.stress());
        let places = Places::of(self.points, self.line, self.plane, self.surface, at, faults);
        Some(SubsurfaceTask { side: self.body.into(), poisson_ratio: poisson_ratio?, places: places?, fields, bulk })
    }
}

/// Poisson's ratio of a body, from the material or from the request.
pub(crate) fn poisson_ratio(
    body: BodyName,
    given: Option<f64>,
    contact: &ContactDefinition,
    at: JsonPath<'_>,
    faults: &mut Faults,
) -> Option<f64> {
    let known = match contact.material.bodies() {
        None => None,
        Some(bodies) => match bodies.get(usize::from(body == BodyName::Second))? {
            Body::Rigid(_) => {
                return faults
                    .refuse(at.member("body"), "the stress in a rigid body is not known: ask for the other body");
            }
            Body::Elastic(body) => Some(body.poisson_ratio),
        },
    };
    let missing = "give the body's `poisson_ratio`: reduced moduli do not determine it";
    of_body(known, given, missing, at.member("poisson_ratio"), faults)
}

impl Bulk {
    fn stress(&self) -> mechanics::Stress {
        let Bulk { xx, yy, zz, xy, yz, xz } = *self;
        mechanics::Stress::from_components([xx, yy, zz, xy, yz, xz].map(|component| component.unwrap_or(0.0)))
    }
}

//! The meaning of the columns of a cloud, by their names.

use mesh::PointClass;

use super::sink::{Said, Sink, byte};

/// Content of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    /// A coordinate: 0 to 2.
    Place(usize),
    /// Red, green or blue: 0 to 2.
    Color(usize),
    /// All three colours in one number, as PCD has them.
    Packed,
    /// A class as LAS numbers them, or a word.
    Class,
    /// A label: a word says what it is, a number does not.
    Label,
}

impl Role {
    fn from_name(name: &str) -> Option<Self> {
        // `//X`, `"x"`, `x [m]`, `Y(m)`, `scalar_Classification` of CloudCompare.
        let name = name.trim_matches(|c: char| c.is_whitespace() || "/#\"'".contains(c)).to_ascii_lowercase();
        let name = name.split(['(', '[']).next().unwrap_or_default().trim();
        let name = name.strip_prefix("scalar_").unwrap_or(name);
        Some(match name {
            "x" | "x_m" | "xcoord" | "x_coord" | "easting" | "east" => Self::Place(0),
            "y" | "y_m" | "ycoord" | "y_coord" | "northing" | "north" => Self::Place(1),
            "z" | "z_m" | "zcoord" | "z_coord" | "elevation" | "height" | "altitude" => Self::Place(2),
            "r" | "red" | "diffuse_red" | "rf" => Self::Color(0),
            "g" | "green" | "diffuse_green" | "gf" => Self::Color(1),
            "b" | "blue" | "diffuse_blue" | "bf" => Self::Color(2),
            "rgb" | "rgba" => Self::Packed,
            "class" | "classification" => Self::Class,
            "label" | "labels" | "semantic" => Self::Label,
            _ => return None,
        })
    }
}

/// Where a class stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ClassColumn {
    pub(super) at: usize,
    /// Its numbers are those of LAS.
    pub(super) is_numbered: bool,
}

/// Which column is what.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Columns {
    pub(super) place: [usize; 3],
    pub(super) color: Option<[usize; 3]>,
    pub(super) packed: Option<usize>,
    pub(super) class: Option<ClassColumn>,
}

impl Columns {
    /// By the names of all columns; `None` where x, y or z is not among them. Of columns of one name the first counts.
    pub(super) fn named<'a>(names: impl Iterator<Item = &'a str>) -> Option<Self> {
        let (mut place, mut color) = ([None; 3], [None; 3]);
        let (mut packed, mut class, mut label) = (None, None, None);
        for (at, name) in names.enumerate() {
            let to = match Role::from_name(name) {
                Some(Role::Place(k)) => &mut place[k],
                Some(Role::Color(k)) => &mut color[k],
                Some(Role::Packed) => &mut packed,
                Some(Role::Class) => &mut class,
                Some(Role::Label) => &mut label,
                None => continue,
            };
            to.get_or_insert(at);
        }
        let all = |columns: [Option<usize>; 3]| Some([columns[0]?, columns[1]?, columns[2]?]);
        let numbered = class.map(|at| ClassColumn { at, is_numbered: true });
        let class = numbered.or(label.map(|at| ClassColumn { at, is_numbered: false }));
        let color = all(color);
        Some(Self { place: all(place)?, color, packed: packed.filter(|_| color.is_none()), class })
    }

    /// Columns that are used.
    pub(super) fn used(&self) -> impl Iterator<Item = usize> + '_ {
        let class = self.class.map(|c| c.at);
        self.place.into_iter().chain(self.color.into_iter().flatten()).chain(self.packed).chain(class)
    }
}

/// Meaning of a number in a column of classes; `None`: it is no column of classes.
pub(super) fn said(class: ClassColumn, number: f64, sink: &mut Sink) -> Option<Said> {
    if !class.is_numbered {
        return None;
    }
    Some(byte(number).map_or(Said::Class(PointClass::Unknown), |number| sink.numbered(number)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_found_whatever_their_order_and_spelling() {
        let of = |names: &str| Columns::named(names.split(','));
        let found = of("id,//X,Y [m],Z(m),Intensity,R,G,B,scalar_Classification").unwrap();
        assert_eq!((found.place, found.color), ([1, 2, 3], Some([5, 6, 7])));
        assert_eq!(found.class, Some(ClassColumn { at: 8, is_numbered: true }));
        let found = of("z,y,x,label").unwrap();
        assert_eq!((found.place, found.color), ([2, 1, 0], None));
        assert_eq!(found.class, Some(ClassColumn { at: 3, is_numbered: false }));
        let found = of("\"Northing\",\"Easting\",\"Height\",rgb").unwrap();
        assert_eq!((found.place, found.packed), ([1, 0, 2], Some(3)));
        assert_eq!((of("x,y,height_rank"), of("1,2,3")), (None, None));
    }
}

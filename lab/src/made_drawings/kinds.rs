//! Made drawings of every kind of plant, and of other things: for the model of kinds, where people's drawings for
//! training are few.
//!
//! They show the structure of a kind, not the manner of any one drawing.

use base::{Draw, Seed, Stream};
use reading::Kind;

use super::{Lines, flower, food, grass, herbs, leafy, things, trees};

/// Makes the lines of one drawing.
type Making = fn(&mut Stream) -> Lines;

/// Makers, each with a word, a kind and a function.
const MAKERS: [(&str, Kind, Making); 71] = [
    ("tree, crown open below", Kind::Tree, trees::open_tree),
    ("tree, crown open below again", Kind::Tree, trees::open_tree),
    ("tree in one line", Kind::Tree, trees::one_line_tree),
    ("tree with branches", Kind::Tree, trees::branched_tree),
    ("bare tree", Kind::Tree, trees::bare_tree),
    ("bare tree with leaves", Kind::Tree, trees::twiggy_tree),
    ("bare tree in one line", Kind::Tree, trees::outlined_tree),
    ("tree of loops", Kind::Tree, trees::looped_tree),
    ("narrow tree", Kind::Tree, trees::narrow_tree),
    ("tree of lobes", Kind::Tree, trees::lobed_tree),
    ("fir, zigzag", Kind::Tree, trees::zigzag_fir),
    ("fir, triangles", Kind::Tree, trees::stacked_fir),
    ("fir, twigs", Kind::Tree, trees::twig_fir),
    ("palm", Kind::Palm, trees::palm),
    ("palm again", Kind::Palm, trees::palm),
    ("bush, cloud", Kind::Bush, herbs::cloud_bush),
    ("bush, humps", Kind::Bush, herbs::humps),
    ("grass, lines", Kind::Grass, |r| grass(r).0),
    ("grass, zigzag", Kind::Grass, herbs::zigzag_grass),
    ("grass, fan", Kind::Grass, herbs::fan),
    ("leaf", Kind::Leaf, herbs::leaf),
    ("leaf again", Kind::Leaf, herbs::leaf),
    ("leaf with lobes", Kind::Leaf, herbs::lobed_leaf),
    ("flower", Kind::Flower, |r| flower(r).0),
    ("flower head", Kind::Flower, herbs::flower_head),
    ("flowers on a branching stem", Kind::Flower, trees::spray),
    ("flowers on a branching stem again", Kind::Flower, trees::spray),
    ("tulip", Kind::Flower, herbs::tulip),
    ("plant in a pot", Kind::HousePlant, herbs::potted),
    ("plant in a pot again", Kind::HousePlant, herbs::potted),
    ("leafy stem", Kind::Stem, |r| leafy(r).0),
    ("sprout", Kind::Stem, herbs::sprout),
    ("carrot", Kind::Vegetable, food::carrot),
    ("mushroom", Kind::Vegetable, food::mushroom),
    ("pod", Kind::Vegetable, food::pod),
    ("onion", Kind::Vegetable, food::onion),
    ("potato", Kind::Vegetable, food::potato),
    ("grapes", Kind::Fruit, food::grapes),
    ("berry", Kind::Fruit, food::berry),
    ("crescent", Kind::Fruit, food::crescent),
    ("slice", Kind::Fruit, food::slice),
    ("strawberry", Kind::Fruit, food::strawberry),
    ("pineapple", Kind::Fruit, food::pineapple),
    ("pear", Kind::Fruit, food::pear),
    ("spears", Kind::Vegetable, food::spears),
    ("bean", Kind::Vegetable, food::bean),
    ("open pod", Kind::Vegetable, food::open_pod),
    ("round root", Kind::Vegetable, food::round_root),
    ("ribbed body", Kind::Vegetable, food::ribbed),
    ("bare body", Kind::Vegetable, food::bare_body),
    ("pointed root", Kind::Vegetable, food::pointed_root),
    ("mushroom again", Kind::Vegetable, food::other_mushroom),
    ("round berries", Kind::Fruit, food::round_berries),
    ("hanging berries", Kind::Fruit, food::hanging),
    ("bumpy berry", Kind::Fruit, food::bumpy_berry),
    ("palm in few strokes", Kind::Palm, trees::palm_in_few),
    ("tree of few lines", Kind::Tree, trees::sparse_tree),
    ("willow", Kind::Tree, trees::willow),
    ("tree with a loose crown", Kind::Tree, trees::loose_tree),
    ("pointed tree", Kind::Tree, trees::pointed_tree),
    ("cactus with arms", Kind::Cactus, herbs::saguaro),
    ("round cactus", Kind::Cactus, herbs::round_cactus),
    ("flower of arcs and lines", Kind::Flower, herbs::other_flower),
    ("vase", Kind::HousePlant, herbs::vase),
    ("tufts", Kind::Grass, herbs::tufts),
    ("leaf of another form", Kind::Leaf, herbs::other_leaf),
    ("bush of arcs and scribbles", Kind::Bush, herbs::other_bush),
    ("frond", Kind::Stem, herbs::other_stem),
    ("tree, trunk behind its crown", Kind::Tree, trees::hidden_trunk),
    ("tulip with tall leaves", Kind::Flower, herbs::tall_tulip),
    ("bouquet", Kind::HousePlant, herbs::bouquet),
];

/// Makers of things other than plants, each with a word and a function.
const OTHERS: [(&str, Making); 21] = [
    ("house", things::house),
    ("cat", things::cat),
    ("face", things::face),
    ("person", things::person),
    ("car", things::car),
    ("fish", things::fish),
    ("sun", things::sun),
    ("letters", things::letters),
    ("star", things::star),
    ("spiral", things::spiral),
    ("boat", things::boat),
    ("cup", things::cup),
    ("table", things::table),
    ("arrow", things::arrow),
    ("box", things::cube),
    ("hills", things::hills),
    ("butterfly", things::butterfly),
    ("birds", things::birds),
    ("sun in a corner", things::corner_sun),
    ("word", things::written),
    ("fence", things::fence),
];

/// Makes drawings of each maker, with their words and kinds; [`Kind::None`] is not a plant.
pub(crate) fn make_of_kinds(salt: u64, each: u64) -> Vec<(&'static str, Kind, Lines)> {
    let others = OTHERS.iter().map(|&(word, make)| (word, Kind::None, make));
    let makers = MAKERS.iter().copied().chain(others);
    let mut found = Vec::new();
    for (set, (word, kind, make)) in (0_u64..).zip(makers) {
        for k in 0..each {
            let r = &mut Seed::new(50_000 + 1_000 * salt + set).child(k).stream(Draw::Template);
            found.push((word, kind, make(r)));
        }
    }
    found
}

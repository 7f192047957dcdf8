//! Contact and friction where the answer is known.

mod capstan;
mod knots;
mod nets;
mod overhand;
mod plectoneme;
mod set_up;
mod shapes;
mod tube;
mod walls;

//! Contact and friction where the answer is known.

mod capstan;
mod overhand;
mod set_up;
mod walls;

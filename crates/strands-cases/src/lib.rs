//! Named problems with reference answers.

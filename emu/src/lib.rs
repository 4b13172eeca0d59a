//! Machine of lancer: words to effects, time and counts.

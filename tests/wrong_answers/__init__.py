"""Wrong answers that students give to the exercises, and a piece of the hint that each must get."""

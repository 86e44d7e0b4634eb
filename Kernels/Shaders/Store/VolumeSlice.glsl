// What a dispatch does of the work on a whole volume: no dispatch may keep the GPU busy for long.

uniform uvec2 slice; // the first macrocell, or block, and the one behind the last

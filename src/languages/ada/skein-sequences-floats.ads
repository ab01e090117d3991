with Ada.Containers.Vectors;

package Skein.Sequences.Floats is new Ada.Containers.Vectors (Positive, Float);

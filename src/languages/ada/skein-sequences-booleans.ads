with Ada.Containers.Vectors;

package Skein.Sequences.Booleans is new Ada.Containers.Vectors (Positive, Boolean);

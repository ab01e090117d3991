with Ada.Containers.Vectors;

package Skein.Sequences.Characters is new Ada.Containers.Vectors (Positive, Character);

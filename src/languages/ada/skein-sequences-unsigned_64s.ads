with Ada.Containers.Vectors;

package Skein.Sequences.Unsigned_64s is new Ada.Containers.Vectors (Positive, Interfaces.Unsigned_64, Interfaces."=");

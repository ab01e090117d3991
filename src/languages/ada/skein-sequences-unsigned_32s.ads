with Ada.Containers.Vectors;

package Skein.Sequences.Unsigned_32s is new Ada.Containers.Vectors (Positive, Interfaces.Unsigned_32, Interfaces."=");

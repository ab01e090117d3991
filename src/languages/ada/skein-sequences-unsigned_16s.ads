with Ada.Containers.Vectors;

package Skein.Sequences.Unsigned_16s is new Ada.Containers.Vectors (Positive, Interfaces.Unsigned_16, Interfaces."=");

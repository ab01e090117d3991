with Ada.Containers.Vectors;

package Skein.Sequences.References is new Ada.Containers.Vectors (Positive, Reference);

"""Makes a container image of a root file system, as one file that `podman load` and `docker load` take.

usage: oci_image.py ROOT.tar FILE NAME VERSION ARCHITECTURE SECONDS

FILE is an archive of an OCI image layout (image-spec 1.0). Beside its index lies the manifest.json that Docker before version 25 reads
instead: both name the same blobs. All that FILE says of time is SECONDS since 1970, so equal arguments make equal files.
"""

import datetime
import gzip
import hashlib
import io
import json
import shutil
import sys
import tarfile
import tempfile

CONFIG = "application/vnd.oci.image.config.v1+json"
LAYER = "application/vnd.oci.image.layer.v1.tar+gzip"
MANIFEST = "application/vnd.oci.image.manifest.v1+json"
INDEX = "application/vnd.oci.image.index.v1+json"


def main(root, file, name, version, architecture, seconds):
    seconds = int(seconds)
    created = datetime.datetime.fromtimestamp(seconds, datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")
    with open(root, "rb") as plain, tempfile.TemporaryFile() as layer, tarfile.open(file, "w") as archive:
        with gzip.GzipFile("", "wb", 9, layer, mtime=0) as packed:
            shutil.copyfileobj(plain, packed, 1 << 20)
        layers = [add_blob(archive, layer, LAYER, seconds)]
        config = add_json(archive, config_of(digest(plain), version, architecture, created), CONFIG, seconds)
        manifest = add_json(archive, {"schemaVersion": 2, "mediaType": MANIFEST, "config": config, "layers": layers}, MANIFEST, seconds)
        manifest["annotations"] = {"org.opencontainers.image.ref.name": version, "io.containerd.image.name": f"{name}:{version}"}
        manifest["platform"] = {"architecture": architecture, "os": "linux"}
        add_file(archive, "oci-layout", {"imageLayoutVersion": "1.0.0"}, seconds)
        add_file(archive, "index.json", {"schemaVersion": 2, "mediaType": INDEX, "manifests": [manifest]}, seconds)
        for_docker = {"Config": path_of(config), "RepoTags": [f"{name}:{version}"], "Layers": [path_of(each) for each in layers]}
        add_file(archive, "manifest.json", [for_docker], seconds)


def config_of(root, version, architecture, created):
    return {
        "created": created,
        "architecture": architecture,
        "os": "linux",
        "config": {
            "Entrypoint": ["skein"],
            "Cmd": ["--help"],
            "Env": ["PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin", "LANG=C.UTF-8"],
            "Labels": {
                "org.opencontainers.image.title": "Skein",
                "org.opencontainers.image.description": "Autonomous entities on DDS: the tools, both vendors, and the missions",
                "org.opencontainers.image.version": version,
                "org.opencontainers.image.created": created,
                "org.opencontainers.image.licenses": "Apache-2.0",
            },
        },
        "rootfs": {"type": "layers", "diff_ids": [root]},
        "history": [{"created": created, "created_by": "./dev image"}],
    }


def add_blob(archive, content, media_type, seconds):
    """Adds what the open file holds under its digest; its descriptor."""
    size = content.seek(0, io.SEEK_END)
    descriptor = {"mediaType": media_type, "digest": digest(content), "size": size}
    content.seek(0)
    entry = tarfile.TarInfo(path_of(descriptor))
    entry.size, entry.mtime = size, seconds
    archive.addfile(entry, content)
    return descriptor


def add_json(archive, value, media_type, seconds):
    return add_blob(archive, io.BytesIO(json.dumps(value).encode()), media_type, seconds)


def add_file(archive, path, value, seconds):
    content = json.dumps(value).encode()
    entry = tarfile.TarInfo(path)
    entry.size, entry.mtime = len(content), seconds
    archive.addfile(entry, io.BytesIO(content))


def digest(content):
    content.seek(0)
    found = hashlib.sha256()
    while piece := content.read(1 << 20):
        found.update(piece)
    return "sha256:" + found.hexdigest()


def path_of(descriptor):
    return "blobs/" + descriptor["digest"].replace(":", "/")


if __name__ == "__main__":
    if len(sys.argv) != 7:
        sys.exit(__doc__)
    main(*sys.argv[1:])

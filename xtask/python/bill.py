"""Writes the bill of materials of one of our packages: what is linked into it, as CycloneDX, checked against the schema of the standard."""

import argparse
import datetime
import json
import os
import re
import sys
import uuid
from pathlib import Path


def linked(metadata: dict, tree: str) -> dict[str, list[str]]:
    """Ids of the packages in an answer of `cargo tree`, each with those of them that it uses, by `cargo metadata`; ours first.

    The tree says what is linked; metadata also knows what other members of the workspace switch on.
    """
    words = (line.split() for line in tree.splitlines())
    places = dict.fromkeys((word[0], word[1].removeprefix("v")) for word in words if len(word) > 1)
    ids = {(package["name"], package["version"]): package["id"] for package in metadata["packages"]}
    nodes = {node["id"]: node for node in metadata["resolve"]["nodes"]}
    found = [ids[place] for place in places]
    return {key: sorted(set(nodes[key]["dependencies"]) & set(found) - {key}) for key in found}


def checksums(lock: Path) -> dict[tuple[str, str], str]:
    """SHA-256 of the archives that a registry gave, by name and version; of a Cargo.lock."""
    entry = r'^name = "(.+)"\nversion = "(.+)"\nsource = ".+"\nchecksum = "([0-9a-f]{64})"$'
    return {(name, version): value for name, version, value in re.findall(entry, lock.read_text(), re.MULTILINE)}


def bill(metadata: dict, tree: str, lock: Path, product: str):
    """The bill of a product of one of our packages, the first of the tree."""
    from cyclonedx.contrib.license.factories import LicenseFactory
    from cyclonedx.model import ExternalReference, ExternalReferenceType, HashAlgorithm, HashType, XsUri
    from cyclonedx.model.bom import Bom, BomMetaData
    from cyclonedx.model.component import Component, ComponentType
    from packageurl import PackageURL

    packages = {package["id"]: package for package in metadata["packages"]}
    sums, licences, uses = checksums(lock), LicenseFactory(), linked(metadata, tree)

    def component(key: str, kind: ComponentType) -> Component:
        package = packages[key]
        place = (package["name"], package["version"])
        home = package["repository"]
        return Component(
            type=kind, name=product if kind is ComponentType.APPLICATION else package["name"], version=package["version"],
            bom_ref=f"{package['name']}@{package['version']}", description=package["description"],
            # Old manifests write a slash where the standard wants OR.
            licenses=[licences.make_from_string(package["license"].replace("/", " OR "))] if package["license"] else [],
            purl=PackageURL("cargo", None, *place) if package["source"] else None,
            hashes=[HashType(alg=HashAlgorithm.SHA_256, content=sums[place])] if place in sums else [],
            external_references=[ExternalReference(type=ExternalReferenceType.VCS, url=XsUri(home))] if home else [],
        )

    components = {
        key: component(key, ComponentType.LIBRARY if number else ComponentType.APPLICATION) for number, key in enumerate(uses)
    }
    main, *others = components.values()
    # The same sources give the same bytes: no time of the build unless one is given, and no chance.
    time = datetime.datetime.fromtimestamp(int(os.environ.get("SOURCE_DATE_EPOCH", "315532800")), datetime.timezone.utc)
    number = uuid.uuid5(uuid.NAMESPACE_URL, " ".join([product, *sorted(uses), *sorted(sums.values())]))
    document = Bom(serial_number=number, metadata=BomMetaData(component=main, timestamp=time), components=others)
    for key, used in uses.items():
        document.register_dependency(components[key], [components[use] for use in used])
    return document


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("metadata", type=Path, help="answer of `cargo metadata`")
    parser.add_argument("tree", type=Path, help="answer of `cargo tree` without prefixes about one of our packages")
    parser.add_argument("lock", type=Path, help="Cargo.lock")
    parser.add_argument("product", help="what it makes")
    parser.add_argument("out", type=Path, help="file to write")
    arguments = parser.parse_args()
    from cyclonedx.output.json import JsonV1Dot6
    from cyclonedx.schema import SchemaVersion
    from cyclonedx.validation.json import JsonStrictValidator

    metadata = json.loads(arguments.metadata.read_text())
    document = bill(metadata, arguments.tree.read_text(), arguments.lock, arguments.product)
    text = JsonV1Dot6(document).output_as_string(indent=2)
    if (error := JsonStrictValidator(SchemaVersion.V1_6).validate_str(text)) is not None:
        print(f"error: the bill of {arguments.product} breaks the schema of CycloneDX 1.6: {error}", file=sys.stderr)
        return 1
    arguments.out.parent.mkdir(parents=True, exist_ok=True)
    arguments.out.write_text(text + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())

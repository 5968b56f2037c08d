#!/usr/bin/env python3
"""Writes the meshes of our scenes into meshes/ beside this file; with --low DIR a coarse copy of rooms.yaml for tests.

What is committed is what this writes. Needs Python 3 and nothing else."""

import argparse
import pathlib
import sys

sys.dont_write_bytecode = True

from modelling import furniture, kitchen, lantern, papers, rooms, things  # noqa: E402
from modelling.detail import Detail  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent


def rooms_meshes(d):
    books = things.shelved_books(d, 1.1, 2.0, 5, 4)
    return rooms.shell() | {
        'sofa_frame': furniture.sofa_frame(d, 1.9),
        'sofa_cushions': furniture.sofa_cushions(d, 1.9, 3),
        'sofa_legs': furniture.sofa_legs(d, 1.9),
        'armchair_frame': furniture.sofa_frame(d, 0.98),
        'armchair_cushions': furniture.sofa_cushions(d, 0.98, 1),
        'armchair_legs': furniture.sofa_legs(d, 0.98),
        'cushion': furniture.cushion(d),
        'chair': furniture.chair(d),
        'coffee_table': furniture.table(d, 1.1, 0.6, 0.42),
        'dining_table': furniture.table(d, 1.8, 0.9, 0.75, 0.035, 0.045),
        'side_table': furniture.round_table(d, 0.24, 0.56),
        'sideboard': furniture.sideboard(d, 1.35),
        'door_leaf': furniture.door_leaf(0.855, 2.024),
        'door_handle': furniture.door_handle(d, 0.855),
        'shelf': things.shelf(d, 1.1, 2.0, 5),
        **{f'books_{i}': mesh for i, mesh in enumerate(books)},
        'lamp_base': things.lamp_base(d),
        'lamp_shade': things.shade(d, 0.17, 0.11, 0.22),
        'pendant_shade': things.shade(d, 0.26, 0.07, 0.2),
        'floor_lamp_stand': things.floor_lamp_stand(d),
        'floor_lamp_shade': things.shade(d, 0.22, 0.15, 0.28),
        'vase': things.vase(d),
        'jar': things.jar(d),
        'bowl': things.bowl(d),
        'pot': things.pot(d),
        'soil': things.soil(d),
        'foliage': things.foliage(d),
        'curtain': things.curtain(d, 1.0, 2.3, 8),
        'frame': things.frame(0.62, 0.46),
        'mirror_frame': things.frame(0.9, 0.7, 0.05),
    }


def lantern_meshes(d):
    return {
        'lantern': lantern.metal(d),
        'round_table': furniture.round_table(d, 0.5, 0.74),
        'burner': things.burner(d),
        'apple': things.apple(d),
        'carafe': things.carafe(d),
        'tumbler': things.tumbler(d),
    }


def paper_meshes(d):
    return {
        'egg': papers.egg(d),
        'uplight': papers.uplight(d),
        'disco_ball': papers.disco_ball(0.3),
        'disco_mirrors': papers.disco_mirrors(0.3, 0.001),
    }


def kitchen_meshes(d):
    window = 1.35, 1.08, 2.95, 2.2
    return {
        'cupboard_door': kitchen.front(d, 0.6, 0.115, 0.855),
        'drawer': kitchen.front(d, 0.6, 0, 0.242),
        'wall_cupboard_door': kitchen.front(d, 0.6, 0, 0.7),
        'cupboard_handle': kitchen.handle(d, 0.16),
        'long_handle': kitchen.handle(d, 0.46),
        'sink': kitchen.sink(0.46, 0.38, 0.19),
        'tap': kitchen.tap(d),
        'pan': kitchen.pan(d),
        'kettle': kitchen.kettle(d),
        'window_wall': kitchen.window_wall(4.2, 2.6, *window),
        'window_frame': kitchen.window_frame(*window),
    }


def write(meshes, folder):
    folder.mkdir(parents=True, exist_ok=True)
    for name, mesh in meshes.items():
        mesh.write_ply(folder / f'{name}.ply')


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--out', type=pathlib.Path, default=HERE / 'meshes', help='folder for the meshes')
    parser.add_argument('--low', type=pathlib.Path, metavar='DIR', help='write a coarse rooms.yaml with its meshes instead')
    arguments = parser.parse_args()
    if arguments.low:
        write(rooms_meshes(Detail(False)), arguments.low / 'meshes')
        (arguments.low / 'rooms.yaml').write_text((HERE / 'rooms.yaml').read_text())
    else:
        write(rooms_meshes(Detail(True)) | lantern_meshes(Detail(True)) | paper_meshes(Detail(True)) | kitchen_meshes(Detail(True)),
              arguments.out)


if __name__ == '__main__':
    main()

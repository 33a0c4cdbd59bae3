#!/usr/bin/env perl
# SPDX-License-Identifier: LGPL-2.1-or-later
# Usage: assembly.pl BILLET [LAUNCHER...]      in an empty current folder; LAUNCHER is mpirun with its option -n
#
# Bodies that fit each other. bolt.prm, drawn with play that 'Initial gap' closes, has the forces of the scene without
# play. pin.prm, a pin in a lug whose facets miss each other, has the force of a fine mesh with 'Surface correction', and
# a warning without; --check warns of the same as the run.
use strict;
use warnings;
use File::Basename;

my $here = dirname(__FILE__);
require "$here/edit_scene.pl";

my ($billet, @launcher) = @ARGV;
my %base = map { $_ => read_text("$here/$_.prm") } 'bolt', 'pin';
my ($n_checks, $n_failed, $n_runs, $said) = (0, 0, 0, '');
enter_folder();

sub check
{
  my ($name, $claim) = @_;
  my $fault = eval { $claim->() } // $@;
  chomp $fault;
  print "$name: ", ($fault eq '' ? "ok\n" : "FAILED: $fault\n");
  ++$n_checks;
  ++$n_failed if $fault ne '';
}

sub near
{
  my ($what, $found, $expected, $tolerance) = @_;
  return abs($found - $expected) <= $tolerance * abs($expected) ? '' : "$what is $found, not $expected";
}

# The last value of a column of the history of a scene with these edits; what was printed is in $said.
sub last_of
{
  my ($column, $base, $edits, $ranks, @options) = @_;
  my $folder = 'r' . ++$n_runs;
  my ($scene) = edit($base{$base}, "Output: Folder = $folder" . ($edits && " & $edits"));
  write_text('scene.prm', $scene);
  (my $code, $said, my $errors) = run(($ranks > 1 ? (@launcher, $ranks) : ()), $billet, @options, 'scene.prm');
  die "exit code $code\n$said$errors" if $code;
  return 0 if @options && $options[0] eq '--check';
  my ($head, @rows) = split /\n/, read_text("$folder/history.csv");
  my @names = split /,/, $head;
  my ($i) = grep { $names[$_] eq $column } 0 .. $#names;
  return (split /,/, $rows[-1])[$i // die "no column '$column'\n"];
}

sub warns { return $said =~ /^warning\[faceted-curvature\]/m ? 1 : 0 }

# --- play -----------------------------------------------------------------------------------------------------------

my $closed = 'plate / Mesh: Translation = 0, 0, 0.01 & face: Point = 0, 0, 1.515 & '
  . 'seat: Initial gap = close within 0.011 & top: Initial gap = close within 0.011';
for my $facets ('overlap', 'bilinear', 'planed')
{
  my $force = last_of('press.force_z', 'bolt', "seat: Facets = $facets", 1);
  for my $ranks (1, 2)
  {
    check "play is closed, $facets, $ranks ranks", sub {
      near('the force', last_of('press.force_z', 'bolt', "$closed & seat: Facets = $facets", $ranks), $force, 1e-4) };
  }
}
check 'play is closed in a first step without force', sub {
  my $force = last_of('press.force_z', 'bolt', "$closed & Motion: Translation = 0 ; 0 ; 0", 1);
  return abs($force) < 1e-9 ? '' : "the force is $force" };

# --- curved faces of one radius ---------------------------------------------------------------------------------------

# Half circles of so many bricks.
sub half_circles
{
  my ($n_lug, $n_pin) = @_;
  return "lug / Mesh: Arguments = 3, $n_lug, 1 : 10, 0, 0 : 20, 180, 1 : true & "
    . "pin / Mesh: Arguments = 3, $n_pin, 1 : 3, 0, 0 : 10, 180, 1 : true";
}
my $shift = ' & fit: Initial penetration = shift';
my $true = ' & fit: Surface correction = cylinder : 0, 0, 0 ; 0, 0, 1';
my $matching = last_of('fit.force_x', 'pin', half_circles(48, 48) . $shift, 1);
check 'faces whose chords match do not warn', sub { warns() ? 'it warns' : '' };
for my $n (10, 12)
{
  my $m = $n + 1;
  check 2 * $n . ' facets: chords make it soft, with a warning', sub {
    my $soft = last_of('fit.force_x', 'pin', half_circles($n, $m) . $shift, 1);
    return !warns() ? 'no warning' : abs($soft) > 0.95 * abs($matching) ? "the force is $soft, beside $matching" : '' };
  check 2 * $n . ' facets: --check warns, too', sub {
    last_of('', 'pin', half_circles($n, $m) . $shift, 2, '--check');
    return warns() ? '' : $said };
  for my $ranks (1, 2)
  {
    check 2 * $n . " facets: the true surface, $ranks ranks", sub {
      my $force = last_of('fit.force_x', 'pin', half_circles($n, $m) . $true, $ranks);
      return warns() ? 'it warns' : near('the force', $force, $matching, 0.03) };
  }
}

# --- meshes -----------------------------------------------------------------------------------------------------------

check 'elements inside out at a corner are warned about', sub {
  my $at = '(abs(x-13.3333)<0.01 && abs(y-90)<0.01)'; # one row of nodes goes beyond a diagonal
  my ($r, $a) = ("(x+2*$at)", "(pi/180*(y+9*$at))");
  last_of('', 'pin', "lug / Mesh: Positions = $r*cos($a) ; $r*sin($a) ; z$shift", 1, '--check');
  return $said =~ /^warning\[inverted-corners\]: 1 element is inside out at a corner.*\(body 'lug'/m ? '' : $said };

printf "%d checks, %d failed\n", $n_checks, $n_failed;
exit($n_failed ? 1 : 0);

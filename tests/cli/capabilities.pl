#!/usr/bin/env perl
# SPDX-License-Identifier: LGPL-2.1-or-later
# Usage: capabilities.pl BILLET [LAUNCHER...]      in an empty current folder; LAUNCHER is mpirun with its option -n
#
# A scene pays for what it asks for and for nothing else: with each capability and without it, what --check says that it
# requires are the lines of capabilities.csv that are not 0, and no other.
use strict;
use warnings;
use File::Basename;

my $here = dirname(__FILE__);
require "$here/edit_scene.pl";

my ($billet, @launcher) = @ARGV;
my ($n_checks, $n_failed, $n_runs) = (0, 0, 0);
enter_folder();

# An elastic block that is pressed from the side; what cases add stands below.
my $static = <<'END';
subsection Bodies
  subsection block
    set Symmetry planes = x = 0 ; y = 0 ; z = 0
    subsection Mesh
      set Primitive    = subdivided_hyper_rectangle
      set Arguments    = 2, 1, 2 : 0, 0, 0 : 2, 1, 2 : true
      set Boundary ids = 7 : abs(z - 2) < 1e-6
    end
    subsection Material
      set Law           = elastic
      set Density       = 1
      set Young modulus = 1000
    end
    subsection Supports
      subsection push
        set Boundary ids = 1
        set Components   = x
        set Displacement = -0.01*t ; 0 ; 0
      end
    end
  end
end
subsection Time stepping
  set End time     = 1
  set Initial step = 0.25
  set Largest step = 0.25
end
subsection Output
  set Format = none
end
END
my $dynamic = 'Time stepping: Scheme = implicit dynamics & + subsection Implicit dynamics\n set Error tolerance = ';
my $load = 'block: + subsection Loads\n subsection weight\n set Type = acceleration\n set Acceleration = 0 ; 0 ; -t\n end\nend';
my $impact = read_text("$here/impact.prm");

sub tool
{
  my ($motion) = @_;
  return "+ subsection Tools\\n subsection die\\n subsection Surfaces\\n subsection face\\n set Point = 0, 0, 2\\n set Normal = 0, 0, -1"
    . "\\n end\\n end\\n subsection Motion\\n $motion\\n end\\n end\\nend";
}
sub pair
{
  my ($what) = @_;
  return "+ subsection Contact pairs\\n subsection top\\n set Body = block\\n set Boundary ids = 7\\n set Normal penalty = 1\\n $what\\n end\\nend";
}
my $die = tool('set Translation = 0 ; 0 ; -0.01*t') . ' & ';
my $other = 'Bodies: + subsection anvil\n set Symmetry planes = x = 0 ; y = 0 ; z = 3\n subsection Mesh\n set Primitive = subdivided_hyper_rectangle'
  . '\n set Arguments = 2, 1, 1 : 0, 0, 2 : 2, 1, 3 : true\n end\n subsection Material\n set Law = elastic\n set Density = 1\n set Young modulus = 1000\n end\nend';
my $plastic = 'Material: Law = elastoplastic & Material: Yield stress = 0.5 & Material: Hardening modulus = 50';
my $on_other = 'set Second body = anvil\n set Second boundary ids = 4\n';

# Name, base, edits, what the scene pays for.
my @cases = (
  ['a body', $static, '', 'Moving support, Matrix'],
  ['plasticity', $static, $plastic, 'Plasticity, Moving support, Matrix'],
  ['stabilisation', $static, 'block: Element = one point', 'Stabilisation, Moving support, Matrix'],
  ['both', $static, "$plastic & block: Element = one point", 'Plasticity, Stabilisation, Moving support, Matrix'],
  ['an unsymmetric tangent', $static, 'Material: Kinematics = hypoelastic & + subsection Solver\n set Material tangent = exact\nend',
    'Moving support, Matrix, Unsymmetric'],
  ['a tool', $static, $die . pair('set Tool = die'), 'Contact, Moving support, Matrix'],
  ['a tool instead of the support', $static, $die . pair('set Tool = die') . ' & Supports: delete', 'Contact, Matrix'],
  ['friction', $static, $die . pair('set Tool = die\n set Friction coefficient = 0.1'), 'Contact, Friction, Moving support, Matrix, Unsymmetric'],
  ['augmentation', $static, $die . pair('set Tool = die\n set Penetration tolerance = 1e-5'), 'Contact, Augmentation, Moving support, Matrix'],
  ['automatic augmentation', $static, $die . pair('set Tool = die\n set Penetration tolerance = automatic'), 'Contact, Augmentation, Moving support, Matrix'],
  ['a driven tool', $static, tool('set Force = t\n set Force direction = 0, 0, -1') . ' & ' . pair('set Tool = die'),
    'Contact, Driven tools, Moving support, Matrix'],
  ['another body', $static, "$other & " . pair($on_other), 'Contact, Body contact, Moving support, Matrix, Unsymmetric'],
  ['another body and friction', $static, "$other & " . pair($on_other . ' set Friction coefficient = 0.1'),
    'Contact, Friction, Body contact, Moving support, Matrix, Unsymmetric'],
  ['another body, augmented', $static, "$other & " . pair($on_other . ' set Penetration tolerance = 1e-5'),
    'Contact, Body contact, Augmentation, Moving support, Matrix, Unsymmetric'],
  ['errors controlled', $static, 'Time stepping: Error tolerance = 1e-2', 'Moving support, Error control, Matrix'],
  ['an iterative solver', $static, '+ subsection Solver\n set Linear solver = CG\nend', 'Moving support, Matrix, Iterative'],
  ['checkpoints', $static, 'Output: + subsection Checkpoint\n set Every steps = 2\nend', 'Moving support, Checkpoints, Matrix'],
  ['implicit dynamics', $static, $dynamic . '0\nend', 'Moving support, Inertia, Matrix'],
  ['a load', $static, $dynamic . "0\\nend & $load", 'Moving support, Inertia, Loads, Matrix'],
  ['its errors controlled', $static, $dynamic . '1e-2\nend', 'Moving support, Inertia, Error control, Matrix'],
  ['explicit: all at once', $impact, '', 'Plasticity, Stabilisation, Contact, Body contact, Edges, Driven tools, Loads, Inertia'],
  ['explicit: no plasticity', $impact, 'block / Material: Law = elastic & block / Material: - Yield stress & block / Material: - Hardening modulus',
    'Stabilisation, Contact, Body contact, Edges, Driven tools, Loads, Inertia'],
  ['explicit: no stabilisation', $impact, 'block: - Element', 'Plasticity, Contact, Body contact, Edges, Driven tools, Loads, Inertia'],
  ['explicit: no loads', $impact, 'Loads: delete', 'Plasticity, Stabilisation, Contact, Body contact, Edges, Driven tools, Inertia'],
  ['explicit: no second body', $impact, 'block on slab: delete', 'Plasticity, Stabilisation, Contact, Driven tools, Loads, Inertia'],
  ['explicit: no tool', $impact, 'Tools: delete & hammer on block: delete', 'Plasticity, Stabilisation, Contact, Body contact, Edges, Loads, Inertia'],
  ['explicit: no contact', $impact, 'Tools: delete & Contact pairs: delete', 'Plasticity, Stabilisation, Loads, Inertia'],
  ['explicit: friction', $impact, 'block on slab: Friction coefficient = 0.1',
    'Plasticity, Stabilisation, Contact, Friction, Body contact, Edges, Driven tools, Loads, Inertia'],
  ['explicit: edges that are free', $impact, 'block on slab: Edges = false',
    'Plasticity, Stabilisation, Contact, Body contact, Driven tools, Loads, Inertia'],
  ['explicit: self-contact', $impact, 'Contact pairs: + subsection folds\n set Body = block\n set Boundary ids = 0, 1\n set Second body = block\nend',
    'Plasticity, Stabilisation, Contact, Body contact, Self-contact, Edges, Driven tools, Loads, Inertia'],
  ['explicit: a support that moves', $impact, 'bottom: Displacement = 0 ; 0 ; -0.01*ramp',
    'Plasticity, Stabilisation, Contact, Body contact, Edges, Moving support, Driven tools, Loads, Inertia'],
  ['explicit: errors controlled', $impact, 'Target error = 5 percent',
    'Plasticity, Stabilisation, Contact, Body contact, Edges, Driven tools, Loads, Inertia, Error control'],
  ['explicit: checkpoints', $impact, 'Output: + subsection Checkpoint\n set Interval = 0.25e-3\nend',
    'Plasticity, Stabilisation, Contact, Body contact, Edges, Driven tools, Loads, Inertia, Checkpoints'],
);
# Of all memory is counted, too, but of checkpoints, which keep nothing after they are written.
my %holds_none = map { $_ => 1 } 'Checkpoints';

sub test
{
  my ($base, $edits, $expected, $ranks) = @_;
  my $folder = 'r' . ++$n_runs;
  my ($scene) = edit($base, "Output: Folder = $folder" . ($edits && " & $edits"));
  write_text('scene.prm', $scene);
  my ($code, $required, $errors) = run($billet, '--check', 'scene.prm');
  return "--check ends with $code: $errors" if $code != 0;
  my %required = map { /^([A-Z][\w -]*?) +(yes|no)\b/ ? ($1 => $2) : () } split /\n/, $required;
  ($code, my $said, $errors) = run(($ranks > 1 ? (@launcher, $ranks) : ()), $billet, 'scene.prm');
  return "it ends with $code: $errors" unless $code == 0 || ($code == 7 && $edits =~ /Target error/); # 7: it is missed

  my ($head, @rows) = split /\n/, read_text("$folder/capabilities.csv");
  return "the columns are $head" if $head ne 'capability,calls,items,bytes';
  my @paid;
  for (@rows)
  {
    my ($name, $calls, $items, $bytes) = split /,/;
    return "$name is paid for, $calls times, $items items, $bytes bytes, and --check says '$required{$name}'"
      if exists $required{$name} && ($required{$name} eq 'yes') != ($calls > 0);
    return "$name has $calls calls, $items items, $bytes bytes" if $calls == 0 && $items + $bytes > 0
      || $calls > 0 && ($items == 0 || !$holds_none{$name} && $bytes == 0);
    delete $required{$name};
    push @paid, $name if $calls > 0;
  }
  return 'no line of ' . join(', ', sort keys %required) if %required;
  my $paid = join ', ', sort @paid;
  $expected = join ', ', sort split /, /, $expected;
  return $paid eq $expected ? '' : "it pays for $paid, not $expected";
}

for my $case (@cases)
{
  my ($name, $base, $edits, $expected) = @$case;
  for my $ranks ($name =~ /^(a body|friction|another body|explicit: all)/ ? (1, 2) : 1)
  {
    my $fault = eval { test($base, $edits, $expected, $ranks) } // $@;
    chomp $fault;
    print "$name, $ranks ranks: ", ($fault eq '' ? "ok\n" : "FAILED: $fault\n");
    ++$n_checks;
    ++$n_failed if $fault ne '';
  }
}
print "$n_checks checks, $n_failed failed\n";
exit($n_failed ? 1 : 0);
